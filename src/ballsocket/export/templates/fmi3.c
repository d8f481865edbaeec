/* The element as an FMU of version 3.0, for model exchange and co-simulation. Written by ballsocket $version. */
#include <stdbool.h>
#include <stdint.h>
#if defined FMI_HEADERS /* those of the standard, in place of what is said of it here */
#include "fmi3Functions.h"
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
#include "fmu_core.h"

#define API EXPORTED fmi3Status
#define ASKED const fmi3ValueReference vr[], size_t n

typedef struct {
    core core;
    fmi3InstanceEnvironment host;
    fmi3LogMessageCallback log;
} instance;

static void say(core *c, int level, const char *message)
{
    static const char *const categories[] = {"", "logStatusWarning", "logStatusDiscard", "logStatusError"};
    const instance *i = (const instance *)c;
    if (i->log)
        i->log(i->host, (fmi3Status)level, categories[level], message);
}

static core *of(fmi3Instance c) { return &((instance *)c)->core; }
static fmi3Status none(fmi3Instance c, size_t n) { return n == 0 ? fmi3OK : (fmi3Status)unknown(of(c)); }
static fmi3Status too_few(fmi3Instance c)
{
    return (fmi3Status)tell(of(c), ERROR, "there are not as many values as value references");
}

static fmi3Instance made(fmi3String token, fmi3InstanceEnvironment host, fmi3LogMessageCallback log)
{
    instance *i = (instance *)calloc(1, sizeof *i);
    if (!i)
        return NULL;
    i->host = host;
    i->log = log;
    i->core.say = say;
    begin(&i->core);
    if (!token || strcmp(token, "$guid")) {
        say(&i->core, ERROR, "this binary belongs to another description: the instantiation tokens differ");
        free(i);
        return NULL;
    }
    return i;
}

EXPORTED const char *fmi3GetVersion(void) { return "3.0"; }
EXPORTED fmi3Instance fmi3InstantiateModelExchange(fmi3String name, fmi3String token, fmi3String resources,
                                                   fmi3Boolean visible, fmi3Boolean logging,
                                                   fmi3InstanceEnvironment host, fmi3LogMessageCallback log)
{
    (void)name, (void)resources, (void)visible, (void)logging;
    return made(token, host, log);
}
EXPORTED fmi3Instance fmi3InstantiateCoSimulation(fmi3String name, fmi3String token, fmi3String resources,
                                                  fmi3Boolean visible, fmi3Boolean logging, fmi3Boolean events,
                                                  fmi3Boolean early, const fmi3ValueReference needed[], size_t n,
                                                  fmi3InstanceEnvironment host, fmi3LogMessageCallback log,
                                                  fmi3IntermediateUpdateCallback update)
{
    (void)name, (void)resources, (void)visible, (void)logging, (void)events, (void)early, (void)needed, (void)n;
    (void)update;
    return made(token, host, log);
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
        log(host, fmi3Error, "logStatusError", "this element is for model exchange and co-simulation");
    return NULL;
}
EXPORTED void fmi3FreeInstance(fmi3Instance c) { free(c); }

API fmi3SetDebugLogging(fmi3Instance c, fmi3Boolean on, size_t n, const fmi3String categories[])
{
    (void)c, (void)on, (void)n, (void)categories;
    return fmi3OK;
}
API fmi3EnterInitializationMode(fmi3Instance c, fmi3Boolean tolerant, fmi3Float64 tolerance, fmi3Float64 start,
                                fmi3Boolean stops, fmi3Float64 stop)
{
    (void)tolerant, (void)tolerance, (void)stops, (void)stop;
    of(c)->now.time = start;
    return fmi3OK;
}
#define NOTHING_TO_DO(name) API name(fmi3Instance c) { (void)c; return fmi3OK; }
NOTHING_TO_DO(fmi3ExitInitializationMode)
NOTHING_TO_DO(fmi3EnterEventMode)
NOTHING_TO_DO(fmi3Terminate)
NOTHING_TO_DO(fmi3EnterConfigurationMode)
NOTHING_TO_DO(fmi3ExitConfigurationMode)
NOTHING_TO_DO(fmi3EvaluateDiscreteStates)
NOTHING_TO_DO(fmi3EnterContinuousTimeMode)
NOTHING_TO_DO(fmi3EnterStepMode)
API fmi3Reset(fmi3Instance c) { begin(of(c)); return fmi3OK; }

API fmi3GetFloat64(fmi3Instance c, ASKED, fmi3Float64 values[], size_t count)
{
    return count < n ? too_few(c) : (fmi3Status)get_numbers(of(c), vr, n, values);
}
API fmi3SetFloat64(fmi3Instance c, ASKED, const fmi3Float64 values[], size_t count)
{
    return count < n ? too_few(c) : (fmi3Status)set_numbers(of(c), vr, n, values);
}
#define NO_VARIABLES(kind) \
    API fmi3Get##kind(fmi3Instance c, ASKED, fmi3##kind values[], size_t count) \
    { (void)vr, (void)values, (void)count; return none(c, n); } \
    API fmi3Set##kind(fmi3Instance c, ASKED, const fmi3##kind values[], size_t count) \
    { (void)vr, (void)values, (void)count; return none(c, n); }
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
API fmi3GetBinary(fmi3Instance c, ASKED, size_t sizes[], fmi3Binary values[], size_t count)
{
    (void)vr, (void)sizes, (void)values, (void)count;
    return none(c, n);
}
API fmi3SetBinary(fmi3Instance c, ASKED, const size_t sizes[], const fmi3Binary values[], size_t count)
{
    (void)vr, (void)sizes, (void)values, (void)count;
    return none(c, n);
}
API fmi3GetClock(fmi3Instance c, ASKED, fmi3Clock values[]) { (void)vr, (void)values; return none(c, n); }
API fmi3SetClock(fmi3Instance c, ASKED, const fmi3Clock values[]) { (void)vr, (void)values; return none(c, n); }

API fmi3GetNumberOfVariableDependencies(fmi3Instance c, fmi3ValueReference number, size_t *count)
{
    *count = is_output(number) ? (number > INPUTS + 6 ? 3 : INPUTS) : 0;
    return number < VARIABLES ? fmi3OK : (fmi3Status)unknown(of(c));
}
API fmi3GetVariableDependencies(fmi3Instance c, fmi3ValueReference dependent, size_t elements[],
                                fmi3ValueReference independents[], size_t places[], fmi3DependencyKind kinds[],
                                size_t count)
{
    size_t k, there;
    const fmi3Status status = fmi3GetNumberOfVariableDependencies(c, dependent, &there);
    for (k = 0; k < count && k < there; k++) {
        elements[k] = places[k] = 0;
        independents[k] = (fmi3ValueReference)(1 + k);
        kinds[k] = fmi3Dependent;
    }
    return status;
}

API fmi3GetFMUState(fmi3Instance c, fmi3FMUState *kept)
{
    if (!*kept && !(*kept = malloc(sizeof(memory))))
        return (fmi3Status)tell(of(c), ERROR, "there is no memory left");
    memcpy(*kept, &of(c)->now, sizeof(memory));
    return fmi3OK;
}
API fmi3SetFMUState(fmi3Instance c, fmi3FMUState kept)
{
    memcpy(&of(c)->now, kept, sizeof(memory));
    of(c)->fresh = 0;
    return fmi3OK;
}
API fmi3FreeFMUState(fmi3Instance c, fmi3FMUState *kept)
{
    (void)c;
    free(*kept);
    *kept = NULL;
    return fmi3OK;
}
API fmi3SerializedFMUStateSize(fmi3Instance c, fmi3FMUState kept, size_t *size)
{
    (void)c, (void)kept;
    *size = sizeof(memory);
    return fmi3OK;
}
API fmi3SerializeFMUState(fmi3Instance c, fmi3FMUState kept, fmi3Byte bytes[], size_t size)
{
    if (size < sizeof(memory))
        return (fmi3Status)tell(of(c), ERROR, "the room for a state is too small");
    memcpy(bytes, kept, sizeof(memory));
    return fmi3OK;
}
API fmi3DeserializeFMUState(fmi3Instance c, const fmi3Byte bytes[], size_t size, fmi3FMUState *kept)
{
    if (size < sizeof(memory) || (!*kept && !(*kept = malloc(sizeof(memory)))))
        return (fmi3Status)tell(of(c), ERROR, "what was kept is no state of this element");
    memcpy(*kept, bytes, sizeof(memory));
    return fmi3OK;
}

API fmi3GetDirectionalDerivative(fmi3Instance c, const fmi3ValueReference unknowns[], size_t many,
                                 const fmi3ValueReference knowns[], size_t known, const fmi3Float64 seed[],
                                 size_t seeds, fmi3Float64 sensitivity[], size_t sensitivities)
{
    if (seeds < known || sensitivities < many)
        return too_few(c);
    return (fmi3Status)directional(of(c), unknowns, many, knowns, known, seed, sensitivity);
}
API fmi3GetAdjointDerivative(fmi3Instance c, const fmi3ValueReference unknowns[], size_t many,
                             const fmi3ValueReference knowns[], size_t known, const fmi3Float64 seed[], size_t seeds,
                             fmi3Float64 sensitivity[], size_t sensitivities)
{
    const fmi3Float64 one = 1.0;
    fmi3Float64 column[OUTPUTS];
    size_t k, u;
    int worst = GOOD, status;
    if (seeds < many || sensitivities < known || many > OUTPUTS)
        return too_few(c);
    for (k = 0; k < known; k++) {
        if ((status = directional(of(c), unknowns, many, knowns + k, 1, &one, column)) > worst)
            worst = status;
        sensitivity[k] = 0.0;
        for (u = 0; u < many && status < ERROR; u++)
            sensitivity[k] += seed[u] * column[u];
    }
    return (fmi3Status)worst;
}

API fmi3GetIntervalDecimal(fmi3Instance c, ASKED, fmi3Float64 intervals[], fmi3IntervalQualifier qualifiers[])
{
    (void)vr, (void)intervals, (void)qualifiers;
    return none(c, n);
}
API fmi3GetIntervalFraction(fmi3Instance c, ASKED, fmi3UInt64 counters[], fmi3UInt64 resolutions[],
                            fmi3IntervalQualifier qualifiers[])
{
    (void)vr, (void)counters, (void)resolutions, (void)qualifiers;
    return none(c, n);
}
API fmi3GetShiftDecimal(fmi3Instance c, ASKED, fmi3Float64 shifts[]) { (void)vr, (void)shifts; return none(c, n); }
API fmi3GetShiftFraction(fmi3Instance c, ASKED, fmi3UInt64 counters[], fmi3UInt64 resolutions[])
{
    (void)vr, (void)counters, (void)resolutions;
    return none(c, n);
}
API fmi3SetIntervalDecimal(fmi3Instance c, ASKED, const fmi3Float64 intervals[])
{
    (void)vr, (void)intervals;
    return none(c, n);
}
API fmi3SetIntervalFraction(fmi3Instance c, ASKED, const fmi3UInt64 counters[], const fmi3UInt64 resolutions[])
{
    (void)vr, (void)counters, (void)resolutions;
    return none(c, n);
}
API fmi3SetShiftDecimal(fmi3Instance c, ASKED, const fmi3Float64 shifts[]) { (void)vr, (void)shifts; return none(c, n); }
API fmi3SetShiftFraction(fmi3Instance c, ASKED, const fmi3UInt64 counters[], const fmi3UInt64 resolutions[])
{
    (void)vr, (void)counters, (void)resolutions;
    return none(c, n);
}
API fmi3UpdateDiscreteStates(fmi3Instance c, fmi3Boolean *again, fmi3Boolean *end, fmi3Boolean *nominals,
                             fmi3Boolean *values, fmi3Boolean *timed, fmi3Float64 *next)
{
    (void)c, (void)next;
    *again = *end = *nominals = *values = *timed = false;
    return fmi3OK;
}

API fmi3CompletedIntegratorStep(fmi3Instance c, fmi3Boolean kept, fmi3Boolean *event, fmi3Boolean *end)
{
    (void)c, (void)kept;
    *event = *end = false;
    return fmi3OK;
}
API fmi3SetTime(fmi3Instance c, fmi3Float64 time) { of(c)->now.time = time; return fmi3OK; }
API fmi3SetContinuousStates(fmi3Instance c, const fmi3Float64 x[], size_t n) { (void)x; return none(c, n); }
API fmi3GetContinuousStateDerivatives(fmi3Instance c, fmi3Float64 x[], size_t n) { (void)x; return none(c, n); }
API fmi3GetEventIndicators(fmi3Instance c, fmi3Float64 x[], size_t n) { (void)x; return none(c, n); }
API fmi3GetContinuousStates(fmi3Instance c, fmi3Float64 x[], size_t n) { (void)x; return none(c, n); }
API fmi3GetNominalsOfContinuousStates(fmi3Instance c, fmi3Float64 x[], size_t n) { (void)x; return none(c, n); }
API fmi3GetNumberOfEventIndicators(fmi3Instance c, size_t *n) { (void)c; *n = 0; return fmi3OK; }
API fmi3GetNumberOfContinuousStates(fmi3Instance c, size_t *n) { (void)c; *n = 0; return fmi3OK; }

API fmi3GetOutputDerivatives(fmi3Instance c, ASKED, const fmi3Int32 orders[], fmi3Float64 values[], size_t count)
{
    (void)vr, (void)orders, (void)values, (void)count;
    return none(c, n);
}
API fmi3DoStep(fmi3Instance c, fmi3Float64 time, fmi3Float64 step, fmi3Boolean kept, fmi3Boolean *event,
               fmi3Boolean *end, fmi3Boolean *early, fmi3Float64 *last)
{
    (void)kept;
    *event = *end = *early = false;
    *last = of(c)->now.time = time + step;
    return (fmi3Status)answer(of(c));
}
API fmi3ActivateModelPartition(fmi3Instance c, fmi3ValueReference clock, fmi3Float64 time)
{
    (void)clock, (void)time;
    return (fmi3Status)tell(of(c), ERROR, "this element is for model exchange and co-simulation");
}
