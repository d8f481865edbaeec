/* The joint as an FMU of version $standard, for model exchange and co-simulation. Written by ballsocket $version.
   All quantities are in SI units. Value references: 0 time, 1..9 position, velocity and spin, 10..19 force, moment,
   energy, half angle, largest pressure and status, from 20 on parameters, then constants. The unit has no continuous states. */
#define FMI $fmi

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "$name.h"

#if defined FMI_HEADERS /* the headers of the standard in place of the declarations below */
#include "fmi${fmi}Functions.h"
#elif FMI == 2
typedef void *fmi2Component, *fmi2ComponentEnvironment, *fmi2FMUstate;
typedef unsigned int fmi2ValueReference;
typedef double fmi2Real;
typedef int fmi2Integer, fmi2Boolean;
typedef const char *fmi2String;
typedef char fmi2Byte;
typedef enum { fmi2OK, fmi2Warning, fmi2Discard, fmi2Error, fmi2Fatal, fmi2Pending } fmi2Status;
typedef enum { fmi2ModelExchange, fmi2CoSimulation } fmi2Type;
typedef enum { fmi2DoStepStatus, fmi2PendingStatus, fmi2LastSuccessfulTime, fmi2Terminated } fmi2StatusKind;
typedef struct {
    void (*logger)(fmi2ComponentEnvironment, fmi2String, fmi2Status, fmi2String, fmi2String, ...);
    void *(*allocateMemory)(size_t count, size_t size);
    void (*freeMemory)(void *);
    void (*stepFinished)(fmi2ComponentEnvironment, fmi2Status);
    fmi2ComponentEnvironment componentEnvironment;
} fmi2CallbackFunctions;
typedef struct {
    fmi2Boolean newDiscreteStatesNeeded, terminateSimulation, nominalsOfContinuousStatesChanged;
    fmi2Boolean valuesOfContinuousStatesChanged, nextEventTimeDefined;
    fmi2Real nextEventTime;
} fmi2EventInfo;
#else
typedef void *fmi3Instance, *fmi3InstanceEnvironment, *fmi3FMUState;
typedef uint32_t fmi3ValueReference;
typedef float fmi3Float32;
typedef double fmi3Float64;
typedef int8_t fmi3Int8;
typedef uint8_t fmi3UInt8, fmi3Byte;
typedef int16_t fmi3Int16;
typedef uint16_t fmi3UInt16;
typedef int32_t fmi3Int32;
typedef uint32_t fmi3UInt32;
typedef int64_t fmi3Int64;
typedef uint64_t fmi3UInt64;
typedef bool fmi3Boolean, fmi3Clock;
typedef const char *fmi3String;
typedef const fmi3Byte *fmi3Binary;
typedef enum { fmi3OK, fmi3Warning, fmi3Discard, fmi3Error, fmi3Fatal } fmi3Status;
typedef enum {
    fmi3Independent, fmi3Constant, fmi3Fixed, fmi3Tunable, fmi3Discrete, fmi3Dependent
} fmi3DependencyKind;
typedef enum { fmi3IntervalNotYetKnown, fmi3IntervalUnchanged, fmi3IntervalChanged } fmi3IntervalQualifier;
typedef void (*fmi3LogMessageCallback)(fmi3InstanceEnvironment, fmi3Status, fmi3String, fmi3String);
typedef void (*fmi3ClockUpdateCallback)(fmi3InstanceEnvironment);
typedef void (*fmi3IntermediateUpdateCallback)(fmi3InstanceEnvironment, fmi3Float64, fmi3Boolean, fmi3Boolean,
                                               fmi3Boolean, fmi3Boolean, fmi3Boolean *, fmi3Float64 *);
typedef void (*fmi3LockPreemptionCallback)(void);
typedef void (*fmi3UnlockPreemptionCallback)(void);
#endif

#if defined _WIN32
#define EXPORTED __declspec(dllexport)
#else
#define EXPORTED
#endif
#define API EXPORTED fmi${fmi}Status
#define UNIT fmi${fmi}$handle c
#define REFERENCES const fmi${fmi}ValueReference vr[], size_t n

enum { INPUTS = 9, OUTPUTS = 10, PARAMETERS = $parameters, FIXED = $fixed };
enum { CONSTANTS = 1 + INPUTS + OUTPUTS + PARAMETERS, VARIABLES = CONSTANTS + FIXED };
typedef fmi${fmi}Status result;
enum { OK = fmi${fmi}OK, WARNING = fmi${fmi}Warning, DISCARD = fmi${fmi}Discard, ERROR = fmi${fmi}Error };

/* Numbers that a host can save and restore. */
typedef struct {
    double time, input[INPUTS], parameter[PARAMETERS + FIXED];
} memory;

typedef struct {
    memory now;
    double output[OUTPUTS];
    int evaluated, status, logged[4];
#if FMI == 2
    const fmi2CallbackFunctions *host;
    char name[200];
#else
    fmi3InstanceEnvironment host;
    fmi3LogMessageCallback log;
#endif
} instance;

/* Units of the force element in SI units. */
static const double input_unit[INPUTS] = {1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1.0, 1.0, 1.0};
static const double output_unit[OUTPUTS] = {1.0, 1.0, 1.0, 1e-3, 1e-3, 1e-3, 1e-3, 1.0, 1e6, 1.0};
static const double parameter_unit[PARAMETERS] = {$units};

/* Log one message of each level, not one at each step; return the level. */
static result report(instance *i, int level, const char *message)
{
    static const char *const categories[] = {"", "logStatusWarning", "logStatusDiscard", "logStatusError"};
    if (i->logged[level]++)
        return (result)level;
#if FMI == 2
    if (i->host && i->host->logger)
        i->host->logger(i->host->componentEnvironment, i->name, (result)level, categories[level], "%s", message);
#else
    if (i->log)
        i->log(i->host, (result)level, categories[level], message);
#endif
    return (result)level;
}

static void set_defaults(instance *i)
{
    const double defaults[PARAMETERS + FIXED] = {$starts};
    const double at_rest[INPUTS] = {$inputs};
    memset(&i->now, 0, sizeof i->now);
    memcpy(i->now.input, at_rest, sizeof at_rest);
    memcpy(i->now.parameter, defaults, sizeof defaults);
    memset(i->logged, 0, sizeof i->logged);
    i->evaluated = 0;
}

static instance *check_token(instance *i, const char *token)
{
    set_defaults(i);
    if (token && !strcmp(token, "$guid"))
        return i;
    report(i, ERROR, "this binary belongs to another description: the $token differ");
    free(i);
    return NULL;
}

static void convert_units(const instance *i, double state[INPUTS], ${name}_parameters *p)
{
    double tuned[PARAMETERS];
    int k;
    for (k = 0; k < INPUTS; k++)
        state[k] = i->now.input[k] / input_unit[k];
    for (k = 0; k < PARAMETERS; k++)
        tuned[k] = i->now.parameter[k] / parameter_unit[k];
    memcpy(p, tuned, sizeof *p);
}

static result report_status(instance *i, const ${name}_parameters *p, int status, const double r[3])
{
    char text[300];
    if (status < ${NAME}_FAILED) {
        if (status == ${NAME}_THROUGH_WALL)
            report(i, WARNING, ${name}_sentence(status));
        else if (!${name}_valid(p, r)) {
            snprintf(text, sizeof text, "$beyond; position (%g, %g, %g) mm", r[0], r[1], r[2]);
            report(i, WARNING, text);
        }
        return (result)OK;
    }
    snprintf(text, sizeof text, "%s; position (%g, %g, %g) mm, time %g s", ${name}_sentence(status), r[0], r[1], r[2],
             i->now.time);
    return report(i, status == ${NAME}_THROUGH_WALL ? DISCARD : ERROR, text);
}

static result evaluate(instance *i)
{
    double state[INPUTS], *y = i->output;
    const char *complaint;
    ${name}_parameters p;
    int k, status;
    if (i->evaluated)
        return (result)i->status;
    i->evaluated = 1;
    convert_units(i, state, &p);
    complaint = ${name}_complaint(&p);
    status = ${name}_load(&p, state, state + 3, state + 6, y, y + 3, y + 6);
    ${name}_contact(&p, state, y + 7, y + 8);
    y[9] = status;
    for (k = 0; k < OUTPUTS; k++)
        y[k] = complaint ? NAN : y[k] * output_unit[k];
    i->status = complaint ? report(i, ERROR, complaint) : report_status(i, &p, status, state);
    return (result)i->status;
}

static result unknown_reference(UNIT)
{
    return report((instance *)c, ERROR, "unknown value reference, or a variable that cannot be read or set");
}
static result no_variables(UNIT, size_t n) { return n == 0 ? (result)OK : unknown_reference(c); }
#if FMI == 3
static result too_few(UNIT) { return report((instance *)c, ERROR, "fewer values than value references"); }
#endif

static int is_input(unsigned number) { return number > 0 && number <= INPUTS; }
static int is_output(unsigned number) { return number > INPUTS && number <= INPUTS + OUTPUTS; }

static result get_numbers(UNIT, REFERENCES, double *values)
{
    instance *i = (instance *)c;
    result worst = (result)OK, status;
    size_t k;
    for (k = 0; k < n; k++) {
        const unsigned number = vr[k];
        if (number >= VARIABLES)
            return unknown_reference(c);
        if (is_output(number) && (status = evaluate(i)) > worst)
            worst = status;
        values[k] = number == 0         ? i->now.time
                    : is_input(number)  ? i->now.input[number - 1]
                    : is_output(number) ? i->output[number - 1 - INPUTS]
                                        : i->now.parameter[number - 1 - INPUTS - OUTPUTS];
    }
    return worst;
}

static result set_numbers(UNIT, REFERENCES, const double *values)
{
    instance *i = (instance *)c;
    size_t k;
    for (k = 0; k < n; k++) {
        const unsigned number = vr[k];
        if (number == 0 || is_output(number) || number >= CONSTANTS)
            return unknown_reference(c);
        if (is_input(number))
            i->now.input[number - 1] = values[k];
        else
            i->now.parameter[number - 1 - INPUTS - OUTPUTS] = values[k];
    }
    i->evaluated = 0;
    return (result)OK;
}

static result directional(UNIT, const fmi${fmi}ValueReference unknowns[], size_t many,
                          const fmi${fmi}ValueReference knowns[], size_t known, const double *seed,
                          double *sensitivity)
{
    instance *i = (instance *)c;
    double direction[INPUTS] = {0.0}, slope[OUTPUTS] = {0.0}, state[INPUTS];
    ${name}_parameters p;
    int status;
    size_t k;
    for (k = 0; k < known; k++) {
        if (!is_input(knowns[k]))
            return unknown_reference(c);
        direction[knowns[k] - 1] = seed[k] / input_unit[knowns[k] - 1];
    }
    convert_units(i, state, &p);
    status = ${name}_slope(&p, state, state + 3, state + 6, direction, slope);
    for (k = 0; k < many; k++) {
        if (!is_output(unknowns[k]))
            return unknown_reference(c);
        sensitivity[k] = slope[unknowns[k] - 1 - INPUTS] * output_unit[unknowns[k] - 1 - INPUTS];
    }
    return report_status(i, &p, status, state);
}

/* Functions of both versions. A name that differs in its letters stands in the template as a placeholder. */
EXPORTED const char *fmi${fmi}GetVersion(void) { return "$standard"; }
EXPORTED void fmi${fmi}FreeInstance(UNIT) { free(c); }
#define NO_ACTION(function) API function(UNIT) { (void)c; return (result)OK; }
NO_ACTION(fmi${fmi}ExitInitializationMode)
NO_ACTION(fmi${fmi}EnterEventMode)
NO_ACTION(fmi${fmi}EnterContinuousTimeMode)
NO_ACTION(fmi${fmi}Terminate)
API fmi${fmi}Reset(UNIT) { set_defaults((instance *)c); return (result)OK; }
API fmi${fmi}SetTime(UNIT, double time) { ((instance *)c)->now.time = time; return (result)OK; }
API fmi${fmi}SetDebugLogging(UNIT, fmi${fmi}Boolean on, size_t n, const fmi${fmi}String categories[])
{
    (void)c, (void)on, (void)n, (void)categories;
    return (result)OK;
}

API fmi${fmi}GetFMU$state(UNIT, fmi${fmi}FMU$state *saved)
{
    if (!*saved && !(*saved = malloc(sizeof(memory))))
        return report((instance *)c, ERROR, "there is no memory left");
    memcpy(*saved, &((instance *)c)->now, sizeof(memory));
    return (result)OK;
}
API fmi${fmi}SetFMU$state(UNIT, fmi${fmi}FMU$state saved)
{
    memcpy(&((instance *)c)->now, saved, sizeof(memory));
    ((instance *)c)->evaluated = 0;
    return (result)OK;
}
API fmi${fmi}FreeFMU$state(UNIT, fmi${fmi}FMU$state *saved)
{
    (void)c;
    free(*saved);
    *saved = NULL;
    return (result)OK;
}
API fmi${fmi}SerializedFMU${state}Size(UNIT, fmi${fmi}FMU$state saved, size_t *size)
{
    (void)c, (void)saved;
    *size = sizeof(memory);
    return (result)OK;
}
API fmi${fmi}SerializeFMU$state(UNIT, fmi${fmi}FMU$state saved, fmi${fmi}Byte bytes[], size_t size)
{
    if (size < sizeof(memory))
        return report((instance *)c, ERROR, "the memory for a saved state is too small");
    memcpy(bytes, saved, sizeof(memory));
    return (result)OK;
}
API fmi${fmi}$deserialize(UNIT, const fmi${fmi}Byte bytes[], size_t size, fmi${fmi}FMU$state *saved)
{
    if (size < sizeof(memory) || (!*saved && !(*saved = malloc(sizeof(memory)))))
        return report((instance *)c, ERROR, "the saved bytes are not a state of this joint");
    memcpy(*saved, bytes, sizeof(memory));
    return (result)OK;
}

#define NO_STATES(function, type) API function(UNIT, type x[], size_t n) { (void)x; return no_variables(c, n); }
NO_STATES(fmi${fmi}SetContinuousStates, const double)
NO_STATES(fmi${fmi}GetContinuousStates, double)
NO_STATES(fmi${fmi}GetNominalsOfContinuousStates, double)
NO_STATES(fmi${fmi}GetEventIndicators, double)
NO_STATES(fmi${fmi}Get$derivatives, double)

#if FMI == 2
EXPORTED const char *fmi2GetTypesPlatform(void) { return "default"; }
EXPORTED fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                                       const fmi2CallbackFunctions *host, fmi2Boolean visible, fmi2Boolean logging)
{
    instance *i = (instance *)calloc(1, sizeof *i);
    (void)type, (void)resources, (void)visible, (void)logging;
    if (!i)
        return NULL;
    i->host = host;
    snprintf(i->name, sizeof i->name, "%s", name ? name : "");
    return check_token(i, guid);
}
API fmi2SetupExperiment(UNIT, fmi2Boolean has_tolerance, fmi2Real tolerance, fmi2Real start, fmi2Boolean has_stop,
                        fmi2Real stop)
{
    (void)has_tolerance, (void)tolerance, (void)has_stop, (void)stop;
    return fmi2SetTime(c, start);
}
NO_ACTION(fmi2EnterInitializationMode)

API fmi2GetReal(UNIT, REFERENCES, fmi2Real value[]) { return get_numbers(c, vr, n, value); }
API fmi2SetReal(UNIT, REFERENCES, const fmi2Real value[]) { return set_numbers(c, vr, n, value); }
#define NO_VARIABLES(kind) \
    API fmi2Get##kind(UNIT, REFERENCES, fmi2##kind value[]) { (void)vr, (void)value; return no_variables(c, n); } \
    API fmi2Set##kind(UNIT, REFERENCES, const fmi2##kind value[]) { (void)vr, (void)value; return no_variables(c, n); }
NO_VARIABLES(Integer)
NO_VARIABLES(Boolean)
NO_VARIABLES(String)

API fmi2GetDirectionalDerivative(UNIT, const fmi2ValueReference unknowns[], size_t many,
                                 const fmi2ValueReference knowns[], size_t known, const fmi2Real seed[],
                                 fmi2Real sensitivity[])
{
    return directional(c, unknowns, many, knowns, known, seed, sensitivity);
}
API fmi2NewDiscreteStates(UNIT, fmi2EventInfo *event)
{
    (void)c;
    memset(event, 0, sizeof *event);
    return fmi2OK;
}
API fmi2CompletedIntegratorStep(UNIT, fmi2Boolean no_rollback, fmi2Boolean *event, fmi2Boolean *end)
{
    (void)c, (void)no_rollback;
    *event = *end = 0;
    return fmi2OK;
}
API fmi2SetRealInputDerivatives(UNIT, REFERENCES, const fmi2Integer order[], const fmi2Real value[])
{
    (void)vr, (void)order, (void)value;
    return no_variables(c, n);
}
API fmi2GetRealOutputDerivatives(UNIT, REFERENCES, const fmi2Integer order[], fmi2Real value[])
{
    (void)vr, (void)order, (void)value;
    return no_variables(c, n);
}
API fmi2DoStep(UNIT, fmi2Real time, fmi2Real step, fmi2Boolean no_rollback)
{
    (void)no_rollback;
    fmi2SetTime(c, time + step);
    return evaluate((instance *)c);
}
API fmi2CancelStep(UNIT) { (void)c; return fmi2Error; }
API fmi2GetStatus(UNIT, const fmi2StatusKind kind, fmi2Status *value)
{
    (void)kind;
    *value = evaluate((instance *)c);
    return fmi2OK;
}
API fmi2GetRealStatus(UNIT, const fmi2StatusKind kind, fmi2Real *value)
{
    *value = ((instance *)c)->now.time;
    return kind == fmi2LastSuccessfulTime ? fmi2OK : fmi2Discard;
}
API fmi2GetIntegerStatus(UNIT, const fmi2StatusKind kind, fmi2Integer *value)
{
    (void)c, (void)kind, (void)value;
    return fmi2Discard;
}
API fmi2GetBooleanStatus(UNIT, const fmi2StatusKind kind, fmi2Boolean *value)
{
    (void)c;
    *value = 0;
    return kind == fmi2Terminated ? fmi2OK : fmi2Discard;
}
API fmi2GetStringStatus(UNIT, const fmi2StatusKind kind, fmi2String *value)
{
    (void)c, (void)kind;
    *value = "";
    return fmi2Discard;
}
#else
static fmi3Instance instantiate(fmi3String token, fmi3InstanceEnvironment host, fmi3LogMessageCallback log)
{
    instance *i = (instance *)calloc(1, sizeof *i);
    if (!i)
        return NULL;
    i->host = host;
    i->log = log;
    return check_token(i, token);
}
EXPORTED fmi3Instance fmi3InstantiateModelExchange(fmi3String name, fmi3String token, fmi3String resources,
                                                   fmi3Boolean visible, fmi3Boolean logging,
                                                   fmi3InstanceEnvironment host, fmi3LogMessageCallback log)
{
    (void)name, (void)resources, (void)visible, (void)logging;
    return instantiate(token, host, log);
}
EXPORTED fmi3Instance fmi3InstantiateCoSimulation(fmi3String name, fmi3String token, fmi3String resources,
                                                  fmi3Boolean visible, fmi3Boolean logging, fmi3Boolean events,
                                                  fmi3Boolean early, const fmi3ValueReference needed[], size_t n,
                                                  fmi3InstanceEnvironment host, fmi3LogMessageCallback log,
                                                  fmi3IntermediateUpdateCallback update)
{
    (void)name, (void)resources, (void)visible, (void)logging, (void)events, (void)early, (void)needed, (void)n;
    (void)update;
    return instantiate(token, host, log);
}
EXPORTED fmi3Instance fmi3InstantiateScheduledExecution(fmi3String name, fmi3String token, fmi3String resources,
                                                        fmi3Boolean visible, fmi3Boolean logging,
                                                        fmi3InstanceEnvironment host, fmi3LogMessageCallback log,
                                                        fmi3ClockUpdateCallback update,
                                                        fmi3LockPreemptionCallback lock,
                                                        fmi3UnlockPreemptionCallback unlock)
{
    (void)name, (void)token, (void)resources, (void)visible, (void)logging, (void)update, (void)lock, (void)unlock;
    if (log)
        log(host, fmi3Error, "logStatusError", "this unit is for model exchange and co-simulation");
    return NULL;
}
API fmi3EnterInitializationMode(UNIT, fmi3Boolean has_tolerance, fmi3Float64 tolerance, fmi3Float64 start,
                                fmi3Boolean has_stop, fmi3Float64 stop)
{
    (void)has_tolerance, (void)tolerance, (void)has_stop, (void)stop;
    return fmi3SetTime(c, start);
}
NO_ACTION(fmi3EnterConfigurationMode)
NO_ACTION(fmi3ExitConfigurationMode)
NO_ACTION(fmi3EvaluateDiscreteStates)
NO_ACTION(fmi3EnterStepMode)

API fmi3GetFloat64(UNIT, REFERENCES, fmi3Float64 values[], size_t count)
{
    return count < n ? too_few(c) : get_numbers(c, vr, n, values);
}
API fmi3SetFloat64(UNIT, REFERENCES, const fmi3Float64 values[], size_t count)
{
    return count < n ? too_few(c) : set_numbers(c, vr, n, values);
}
#define NO_VARIABLES(kind) \
    API fmi3Get##kind(UNIT, REFERENCES, fmi3##kind values[], size_t count) \
    { (void)vr, (void)values, (void)count; return no_variables(c, n); } \
    API fmi3Set##kind(UNIT, REFERENCES, const fmi3##kind values[], size_t count) \
    { (void)vr, (void)values, (void)count; return no_variables(c, n); }
NO_VARIABLES(Float32)
NO_VARIABLES(Int8)
NO_VARIABLES(UInt8)
NO_VARIABLES(Int16)
NO_VARIABLES(UInt16)
NO_VARIABLES(Int32)
NO_VARIABLES(UInt32)
NO_VARIABLES(Int64)
NO_VARIABLES(UInt64)
NO_VARIABLES(Boolean)
NO_VARIABLES(String)
API fmi3GetBinary(UNIT, REFERENCES, size_t sizes[], fmi3Binary values[], size_t count)
{
    (void)vr, (void)sizes, (void)values, (void)count;
    return no_variables(c, n);
}
API fmi3SetBinary(UNIT, REFERENCES, const size_t sizes[], const fmi3Binary values[], size_t count)
{
    (void)vr, (void)sizes, (void)values, (void)count;
    return no_variables(c, n);
}

/* Functions on clocks, of which there are none. */
#define NO_CLOCKS(function, type) API function(UNIT, REFERENCES, type x[]) \
    { (void)vr, (void)x; return no_variables(c, n); }
#define NO_CLOCK_PAIRS(function, first, second) API function(UNIT, REFERENCES, first x[], second y[]) \
    { (void)vr, (void)x, (void)y; return no_variables(c, n); }
NO_CLOCKS(fmi3GetClock, fmi3Clock)
NO_CLOCKS(fmi3SetClock, const fmi3Clock)
NO_CLOCKS(fmi3GetShiftDecimal, fmi3Float64)
NO_CLOCKS(fmi3SetShiftDecimal, const fmi3Float64)
NO_CLOCKS(fmi3SetIntervalDecimal, const fmi3Float64)
NO_CLOCK_PAIRS(fmi3GetIntervalDecimal, fmi3Float64, fmi3IntervalQualifier)
NO_CLOCK_PAIRS(fmi3GetShiftFraction, fmi3UInt64, fmi3UInt64)
NO_CLOCK_PAIRS(fmi3SetShiftFraction, const fmi3UInt64, const fmi3UInt64)
NO_CLOCK_PAIRS(fmi3SetIntervalFraction, const fmi3UInt64, const fmi3UInt64)
API fmi3GetIntervalFraction(UNIT, REFERENCES, fmi3UInt64 counters[], fmi3UInt64 resolutions[],
                            fmi3IntervalQualifier qualifiers[])
{
    (void)vr, (void)counters, (void)resolutions, (void)qualifiers;
    return no_variables(c, n);
}

API fmi3GetNumberOfVariableDependencies(UNIT, fmi3ValueReference number, size_t *count)
{
    *count = is_output(number) ? (number > INPUTS + 6 ? 3 : INPUTS) : 0;
    return number < VARIABLES ? fmi3OK : unknown_reference(c);
}
API fmi3GetVariableDependencies(UNIT, fmi3ValueReference dependent, size_t dependent_elements[],
                                fmi3ValueReference independents[], size_t elements[], fmi3DependencyKind kinds[],
                                size_t count)
{
    size_t k, available;
    const fmi3Status status = fmi3GetNumberOfVariableDependencies(c, dependent, &available);
    for (k = 0; k < count && k < available; k++) {
        dependent_elements[k] = elements[k] = 0;
        independents[k] = (fmi3ValueReference)(1 + k);
        kinds[k] = fmi3Dependent;
    }
    return status;
}

API fmi3GetDirectionalDerivative(UNIT, const fmi3ValueReference unknowns[], size_t many,
                                 const fmi3ValueReference knowns[], size_t known, const fmi3Float64 seed[],
                                 size_t seeds, fmi3Float64 sensitivity[], size_t sensitivities)
{
    if (seeds < known || sensitivities < many)
        return too_few(c);
    return directional(c, unknowns, many, knowns, known, seed, sensitivity);
}
API fmi3GetAdjointDerivative(UNIT, const fmi3ValueReference unknowns[], size_t many,
                             const fmi3ValueReference knowns[], size_t known, const fmi3Float64 seed[], size_t seeds,
                             fmi3Float64 sensitivity[], size_t sensitivities)
{
    const fmi3Float64 one = 1.0;
    fmi3Float64 column[OUTPUTS];
    size_t k, u;
    fmi3Status worst = fmi3OK, status;
    if (seeds < many || sensitivities < known || many > OUTPUTS)
        return too_few(c);
    for (k = 0; k < known; k++) {
        if ((status = directional(c, unknowns, many, knowns + k, 1, &one, column)) > worst)
            worst = status;
        sensitivity[k] = 0.0;
        for (u = 0; u < many && status < fmi3Error; u++)
            sensitivity[k] += seed[u] * column[u];
    }
    return worst;
}

API fmi3UpdateDiscreteStates(UNIT, fmi3Boolean *again, fmi3Boolean *end, fmi3Boolean *nominals, fmi3Boolean *values,
                             fmi3Boolean *timed, fmi3Float64 *next)
{
    (void)c, (void)next;
    *again = *end = *nominals = *values = *timed = false;
    return fmi3OK;
}
API fmi3CompletedIntegratorStep(UNIT, fmi3Boolean no_rollback, fmi3Boolean *event, fmi3Boolean *end)
{
    (void)c, (void)no_rollback;
    *event = *end = false;
    return fmi3OK;
}
API fmi3GetNumberOfEventIndicators(UNIT, size_t *n) { (void)c; *n = 0; return fmi3OK; }
API fmi3GetNumberOfContinuousStates(UNIT, size_t *n) { (void)c; *n = 0; return fmi3OK; }
API fmi3GetOutputDerivatives(UNIT, REFERENCES, const fmi3Int32 orders[], fmi3Float64 values[], size_t count)
{
    (void)vr, (void)orders, (void)values, (void)count;
    return no_variables(c, n);
}
API fmi3DoStep(UNIT, fmi3Float64 time, fmi3Float64 step, fmi3Boolean no_rollback, fmi3Boolean *event,
               fmi3Boolean *end, fmi3Boolean *early, fmi3Float64 *last)
{
    (void)no_rollback;
    *event = *end = *early = false;
    *last = time + step;
    fmi3SetTime(c, *last);
    return evaluate((instance *)c);
}
API fmi3ActivateModelPartition(UNIT, fmi3ValueReference clock, fmi3Float64 time)
{
    (void)clock, (void)time;
    return report((instance *)c, ERROR, "this unit is for model exchange and co-simulation");
}
#endif
