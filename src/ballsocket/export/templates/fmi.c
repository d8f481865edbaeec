/* The joint as an FMU of version $standard, for model exchange and co-simulation. Written by ballsocket $version.
   All quantities are in SI units. Value references: 0 time, 1..9 position, velocity and spin, then internal states
   (deflections of bristles, relaxed forces of the liner), applied force and torque (6 with a ball inside), 10 outputs
   (force, moment, energy, half angle, largest pressure and status), rates of the states, parameters, and constants.
   Position, velocity and spin are states of a ball inside, otherwise inputs. */
#define FMI $fmi
#define BALL $ball
#define INTERNAL $internal
#define STATES (INTERNAL + 9 * BALL)

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

enum { MOTION = 9, APPLIED = MOTION + INTERNAL, VALUES = APPLIED + 6 * BALL, FIRST_STATE = MOTION * !BALL };
enum { OUTPUTS = 10, LOADS = OUTPUTS - 1, RESULTS = OUTPUTS + STATES };
enum { PARAMETERS = $parameters, MASS = PARAMETERS, INERTIA, TUNABLES = PARAMETERS + 2 * BALL, FIXED = $fixed };
enum { CONSTANTS = 1 + VALUES + RESULTS + TUNABLES, VARIABLES = CONSTANTS + FIXED };
typedef fmi${fmi}Status result;
enum { OK = fmi${fmi}OK, WARNING = fmi${fmi}Warning, DISCARD = fmi${fmi}Discard, ERROR = fmi${fmi}Error };

/* Numbers that a host can save and restore. */
typedef struct {
    double time, step, value[VALUES], parameter[TUNABLES + FIXED];
} memory;

typedef struct {
    memory now;
    double result[RESULTS];
    int evaluated, status, trying, logged[4];
#if FMI == 2
    const fmi2CallbackFunctions *host;
    char name[200];
#else
    fmi3InstanceEnvironment host;
    fmi3LogMessageCallback log;
#endif
} instance;

/* Units of the force element in SI units. */
static const double value_unit[VALUES] = {$value_units};
static const double output_unit[OUTPUTS] = {1.0, 1.0, 1.0, 1e-3, 1e-3, 1e-3, 1e-3, 1.0, 1e6, 1.0};
static const double parameter_unit[PARAMETERS] = {$units};

/* Log one message of each level, not one at each step, and none on a trial step; return the level. */
static result report(instance *i, int level, const char *message)
{
    static const char *const categories[] = {"", "logStatusWarning", "logStatusDiscard", "logStatusError"};
    if (i->trying || i->logged[level]++)
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
    const double defaults[TUNABLES + FIXED] = {$starts};
    const double at_rest[VALUES] = {$values};
    memset(&i->now, 0, sizeof i->now);
    memcpy(i->now.value, at_rest, sizeof at_rest);
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

static void convert_units(const instance *i, double state[VALUES], ${name}_parameters *p)
{
    double tuned[PARAMETERS];
    int k;
    for (k = 0; k < VALUES; k++)
        state[k] = i->now.value[k] / value_unit[k];
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

/* Rates of the states, linear in the values x and the loads y; `inner` has those of internal states in package units. */
static void find_rates(const instance *i, const double x[VALUES], double y[RESULTS], const double *inner)
{
    double *rate = y + OUTPUTS;
    int k;
    (void)i, (void)x, (void)inner, (void)rate, (void)k;
#if BALL
    for (k = 0; k < 3; k++) {
        rate[k] = x[3 + k];
        rate[3 + k] = (y[k] + x[APPLIED + k]) / i->now.parameter[MASS];
        rate[6 + k] = (y[3 + k] + x[APPLIED + 3 + k]) / i->now.parameter[INERTIA];
    }
#endif
#if INTERNAL
    for (k = 0; k < INTERNAL; k++)
        rate[9 * BALL + k] = inner[k] * value_unit[MOTION + k];
#endif
}

static const char *complaint_of(const instance *i, const ${name}_parameters *p)
{
#if BALL
    const double mass = i->now.parameter[MASS], inertia = i->now.parameter[INERTIA];
    if (!(mass > 0.0 && 1.0 / mass < INFINITY && inertia > 0.0 && 1.0 / inertia < INFINITY))
        return "mass and inertia must be above 0, and their reciprocals finite";
#endif
    (void)i;
    return ${name}_complaint(p);
}

static result evaluate(instance *i)
{
    double s[VALUES], inner[INTERNAL + 1], *y = i->result;
    const char *complaint;
    ${name}_parameters p;
    int k, status;
    if (i->evaluated)
        return (result)i->status;
    i->evaluated = 1;
    convert_units(i, s, &p);
    complaint = complaint_of(i, &p);
    status = ${name}_load(&p, s, s + 3, s + 6$at_internal, y, y + 3, y + 6$into_rates);
    ${name}_contact(&p, s, y + 7, y + 8);
    y[9] = status;
    for (k = 0; k < OUTPUTS; k++)
        y[k] *= output_unit[k];
    find_rates(i, i->now.value, y, inner);
    for (k = 0; complaint && k < RESULTS; k++)
        y[k] = NAN;
    i->status = complaint ? report(i, ERROR, complaint) : report_status(i, &p, status, s);
    return (result)i->status;
}

#if STATES
/* Advance the states by the pair of Dormand and Prince of orders 5 and 4. The error of a step stays below 1e-10 of each
   state and its unit, as in Python. */
static result advance(instance *i, double end)
{
    static const double stage[6][6] = {{1.0 / 5},
                                       {3.0 / 40, 9.0 / 40},
                                       {44.0 / 45, -56.0 / 15, 32.0 / 9},
                                       {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
                                       {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
                                       {35.0 / 384, 0.0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84}};
    static const double error[7] = {71.0 / 57600,      0.0,        -71.0 / 16695, 71.0 / 1920,
                                    -17253.0 / 339200, 22.0 / 525, -1.0 / 40};
    double *x = i->now.value + FIRST_STATE, start[STATES], rate[7][STATES], h, worst, sum;
    long trial;
    int status, j, k, n;
    for (trial = 0; i->now.time < end; trial++) {
        h = i->now.step > 0.0 && i->now.step < end - i->now.time ? i->now.step : end - i->now.time;
        if (trial == 10000000 || i->now.time + h == i->now.time)
            return report(i, ERROR, "the states cannot be integrated: their rates are not finite, or too large");
        if ((status = evaluate(i)) >= DISCARD)
            return (result)status;
        memcpy(start, x, sizeof start);
        memcpy(rate[0], i->result + OUTPUTS, sizeof start);
        i->trying = 1;
        for (n = 0; n < 6; n++) {
            for (k = 0; k < STATES; k++) {
                for (j = 0, sum = 0.0; j <= n; j++)
                    sum += stage[n][j] * rate[j][k];
                x[k] = start[k] + h * sum;
            }
            i->evaluated = 0;
            evaluate(i);
            memcpy(rate[n + 1], i->result + OUTPUTS, sizeof start);
        }
        i->trying = i->evaluated = 0;
        for (k = 0, worst = 1e-10; k < STATES; k++) {
            for (j = 0, sum = 0.0; j < 7; j++)
                sum += error[j] * rate[j][k];
            sum = fabs(h * sum) / (1e-10 * (value_unit[FIRST_STATE + k] + fabs(x[k])));
            worst = sum > worst || sum != sum ? sum : worst;
        }
        if (worst <= 1.0)
            i->now.time = h < end - i->now.time ? i->now.time + h : end;
        else
            memcpy(x, start, sizeof start);
        i->now.step = h * (worst > 1e-10 ? fmax(0.1, fmin(5.0, 0.9 * pow(worst, -0.2))) : worst > 0.0 ? 5.0 : 0.1);
    }
    return evaluate(i);
}
#else
static result advance(instance *i, double end)
{
    i->now.time = end;
    return evaluate(i);
}
#endif

static result unknown_reference(UNIT)
{
    return report((instance *)c, ERROR, "unknown value reference, or a variable that cannot be read or set");
}
static result no_variables(UNIT, size_t n) { return n == 0 ? (result)OK : unknown_reference(c); }
#if FMI == 3
static result too_few(UNIT) { return report((instance *)c, ERROR, "fewer values than value references"); }
#endif

/* Number with a value reference below VARIABLES: time, values, results, parameters and constants. */
static double *place(instance *i, unsigned number)
{
    if (number == 0)
        return &i->now.time;
    if (number <= VALUES)
        return i->now.value + number - 1;
    if (number <= VALUES + RESULTS)
        return i->result + number - 1 - VALUES;
    return i->now.parameter + number - 1 - VALUES - RESULTS;
}
static int is_result(unsigned number) { return number > VALUES && number <= VALUES + RESULTS; }

static result get_numbers(UNIT, REFERENCES, double *values)
{
    instance *i = (instance *)c;
    result worst = (result)OK, status;
    size_t k;
    for (k = 0; k < n; k++) {
        if (vr[k] >= VARIABLES)
            return unknown_reference(c);
        if (is_result(vr[k]) && (status = evaluate(i)) > worst)
            worst = status;
        values[k] = *place(i, vr[k]);
    }
    return worst;
}

static result set_numbers(UNIT, REFERENCES, const double *values)
{
    instance *i = (instance *)c;
    size_t k;
    for (k = 0; k < n; k++) {
        if (vr[k] == 0 || is_result(vr[k]) || vr[k] >= CONSTANTS)
            return unknown_reference(c);
        *place(i, vr[k]) = values[k];
    }
    i->evaluated = 0;
    return (result)OK;
}

static result directional(UNIT, const fmi${fmi}ValueReference unknowns[], size_t many,
                          const fmi${fmi}ValueReference knowns[], size_t known, const double *seed,
                          double *sensitivity)
{
    instance *i = (instance *)c;
    double direction[VALUES] = {0.0}, way[VALUES], slope[APPLIED], result_slope[RESULTS] = {0.0}, s[VALUES];
    const char *complaint;
    ${name}_parameters p;
    int status, j;
    size_t k;
    for (k = 0; k < known; k++) {
        if (knowns[k] == 0 || knowns[k] > VALUES)
            return unknown_reference(c);
        direction[knowns[k] - 1] = seed[k];
    }
    for (j = 0; j < VALUES; j++)
        way[j] = direction[j] / value_unit[j];
    convert_units(i, s, &p);
    if ((complaint = complaint_of(i, &p)))
        return report(i, ERROR, complaint);
    status = ${name}_slope(&p, s, s + 3, s + 6$at_internal, way, slope);
    for (j = 0; j < LOADS; j++)
        result_slope[j] = slope[j] * output_unit[j];
    find_rates(i, direction, result_slope, slope + LOADS);
    for (k = 0; k < many; k++) {
        if (unknowns[k] == 0 || unknowns[k] > VALUES + RESULTS)
            return unknown_reference(c);
        sensitivity[k] = is_result(unknowns[k]) ? result_slope[unknowns[k] - 1 - VALUES] : direction[unknowns[k] - 1];
    }
    return report_status(i, &p, status, s);
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

static result wrong_count(UNIT) { return report((instance *)c, ERROR, "a wrong number of states"); }
API fmi${fmi}SetContinuousStates(UNIT, const double x[], size_t n)
{
    if (n != STATES)
        return wrong_count(c);
    memcpy(((instance *)c)->now.value + FIRST_STATE, x, n * sizeof *x);
    ((instance *)c)->evaluated = 0;
    return (result)OK;
}
API fmi${fmi}GetContinuousStates(UNIT, double x[], size_t n)
{
    if (n != STATES)
        return wrong_count(c);
    memcpy(x, ((instance *)c)->now.value + FIRST_STATE, n * sizeof *x);
    return (result)OK;
}
API fmi${fmi}GetNominalsOfContinuousStates(UNIT, double x[], size_t n)
{
    if (n != STATES)
        return wrong_count(c);
    memcpy(x, value_unit + FIRST_STATE, n * sizeof *x);
    return (result)OK;
}
API fmi${fmi}Get$derivatives(UNIT, double x[], size_t n)
{
    const result status = n == STATES ? evaluate((instance *)c) : wrong_count(c);
    if (n == STATES)
        memcpy(x, ((instance *)c)->result + OUTPUTS, n * sizeof *x);
    return status;
}
API fmi${fmi}GetEventIndicators(UNIT, double x[], size_t n) { (void)x; return no_variables(c, n); }

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
    fmi2SetTime(c, time);
    return advance((instance *)c, time + step);
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
    const unsigned row = number - VALUES;
    *count = !is_result(number) ? 0 : row > OUTPUTS ? VALUES : row > 6 ? 3 : APPLIED;
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
    fmi3Float64 column[VALUES + RESULTS];
    size_t k, u;
    fmi3Status worst = fmi3OK, status;
    if (seeds < many || sensitivities < known || many > VALUES + RESULTS)
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
API fmi3GetNumberOfContinuousStates(UNIT, size_t *n) { (void)c; *n = STATES; return fmi3OK; }
API fmi3GetOutputDerivatives(UNIT, REFERENCES, const fmi3Int32 orders[], fmi3Float64 values[], size_t count)
{
    (void)vr, (void)orders, (void)values, (void)count;
    return no_variables(c, n);
}
API fmi3DoStep(UNIT, fmi3Float64 time, fmi3Float64 step, fmi3Boolean no_rollback, fmi3Boolean *event,
               fmi3Boolean *end, fmi3Boolean *early, fmi3Float64 *last)
{
    fmi3Status status;
    (void)no_rollback;
    *event = *end = *early = false;
    fmi3SetTime(c, time);
    status = advance((instance *)c, time + step);
    *last = ((instance *)c)->now.time;
    return status;
}
API fmi3ActivateModelPartition(UNIT, fmi3ValueReference clock, fmi3Float64 time)
{
    (void)clock, (void)time;
    return report((instance *)c, ERROR, "this unit is for model exchange and co-simulation");
}
#endif
