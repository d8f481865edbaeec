/* The element as an FMU of version 2.0, for model exchange and co-simulation. Written by ballsocket $version. */
#if defined FMI_HEADERS /* those of the standard, in place of what is said of it here */
#include "fmi2Functions.h"
#else
#include <stddef.h>
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
#endif
#include "fmu_core.h"

#define API EXPORTED fmi2Status
#define ASKED const fmi2ValueReference vr[], size_t n

typedef struct {
    core core;
    const fmi2CallbackFunctions *host;
    char name[200];
} instance;

static void say(core *c, int level, const char *message)
{
    static const char *const categories[] = {"", "logStatusWarning", "logStatusDiscard", "logStatusError"};
    const instance *i = (const instance *)c;
    if (i->host && i->host->logger)
        i->host->logger(i->host->componentEnvironment, i->name, (fmi2Status)level, categories[level], "%s", message);
}

static core *of(fmi2Component c) { return &((instance *)c)->core; }
static fmi2Status none(fmi2Component c, size_t n) { return n == 0 ? fmi2OK : (fmi2Status)unknown(of(c)); }

EXPORTED const char *fmi2GetTypesPlatform(void) { return "default"; }
EXPORTED const char *fmi2GetVersion(void) { return "2.0"; }

EXPORTED fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                                       const fmi2CallbackFunctions *host, fmi2Boolean visible, fmi2Boolean logging)
{
    instance *i = (instance *)calloc(1, sizeof *i);
    (void)type, (void)resources, (void)visible, (void)logging;
    if (!i)
        return NULL;
    i->host = host;
    i->core.say = say;
    snprintf(i->name, sizeof i->name, "%s", name ? name : "");
    begin(&i->core);
    if (!guid || strcmp(guid, "$guid")) {
        say(&i->core, ERROR, "this binary belongs to another description: the GUIDs differ");
        free(i);
        return NULL;
    }
    return i;
}

EXPORTED void fmi2FreeInstance(fmi2Component c) { free(c); }
API fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t n, const fmi2String categories[])
{
    (void)c, (void)on, (void)n, (void)categories;
    return fmi2OK;
}
API fmi2SetupExperiment(fmi2Component c, fmi2Boolean tolerant, fmi2Real tolerance, fmi2Real start, fmi2Boolean stops,
                        fmi2Real stop)
{
    (void)tolerant, (void)tolerance, (void)stops, (void)stop;
    of(c)->now.time = start;
    return fmi2OK;
}
API fmi2EnterInitializationMode(fmi2Component c) { (void)c; return fmi2OK; }
API fmi2ExitInitializationMode(fmi2Component c) { (void)c; return fmi2OK; }
API fmi2Terminate(fmi2Component c) { (void)c; return fmi2OK; }
API fmi2Reset(fmi2Component c) { begin(of(c)); return fmi2OK; }

API fmi2GetReal(fmi2Component c, ASKED, fmi2Real value[]) { return (fmi2Status)get_numbers(of(c), vr, n, value); }
API fmi2SetReal(fmi2Component c, ASKED, const fmi2Real value[])
{
    return (fmi2Status)set_numbers(of(c), vr, n, value);
}
API fmi2GetInteger(fmi2Component c, ASKED, fmi2Integer value[]) { (void)vr, (void)value; return none(c, n); }
API fmi2GetBoolean(fmi2Component c, ASKED, fmi2Boolean value[]) { (void)vr, (void)value; return none(c, n); }
API fmi2GetString(fmi2Component c, ASKED, fmi2String value[]) { (void)vr, (void)value; return none(c, n); }
API fmi2SetInteger(fmi2Component c, ASKED, const fmi2Integer value[]) { (void)vr, (void)value; return none(c, n); }
API fmi2SetBoolean(fmi2Component c, ASKED, const fmi2Boolean value[]) { (void)vr, (void)value; return none(c, n); }
API fmi2SetString(fmi2Component c, ASKED, const fmi2String value[]) { (void)vr, (void)value; return none(c, n); }

API fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *kept)
{
    if (!*kept && !(*kept = malloc(sizeof(memory))))
        return (fmi2Status)tell(of(c), ERROR, "there is no memory left");
    memcpy(*kept, &of(c)->now, sizeof(memory));
    return fmi2OK;
}
API fmi2SetFMUstate(fmi2Component c, fmi2FMUstate kept)
{
    memcpy(&of(c)->now, kept, sizeof(memory));
    of(c)->fresh = 0;
    return fmi2OK;
}
API fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *kept)
{
    (void)c;
    free(*kept);
    *kept = NULL;
    return fmi2OK;
}
API fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate kept, size_t *size)
{
    (void)c, (void)kept;
    *size = sizeof(memory);
    return fmi2OK;
}
API fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate kept, fmi2Byte bytes[], size_t size)
{
    if (size < sizeof(memory))
        return (fmi2Status)tell(of(c), ERROR, "the room for a state is too small");
    memcpy(bytes, kept, sizeof(memory));
    return fmi2OK;
}
API fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte bytes[], size_t size, fmi2FMUstate *kept)
{
    if (size < sizeof(memory) || (!*kept && !(*kept = malloc(sizeof(memory)))))
        return (fmi2Status)tell(of(c), ERROR, "what was kept is no state of this element");
    memcpy(*kept, bytes, sizeof(memory));
    return fmi2OK;
}

API fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference unknowns[], size_t many,
                                 const fmi2ValueReference knowns[], size_t known, const fmi2Real seed[],
                                 fmi2Real sensitivity[])
{
    return (fmi2Status)directional(of(c), unknowns, many, knowns, known, seed, sensitivity);
}

API fmi2EnterEventMode(fmi2Component c) { (void)c; return fmi2OK; }
API fmi2EnterContinuousTimeMode(fmi2Component c) { (void)c; return fmi2OK; }
API fmi2NewDiscreteStates(fmi2Component c, fmi2EventInfo *event)
{
    (void)c;
    memset(event, 0, sizeof *event);
    return fmi2OK;
}
API fmi2CompletedIntegratorStep(fmi2Component c, fmi2Boolean kept, fmi2Boolean *event, fmi2Boolean *end)
{
    (void)c, (void)kept;
    *event = *end = 0;
    return fmi2OK;
}
API fmi2SetTime(fmi2Component c, fmi2Real time) { of(c)->now.time = time; return fmi2OK; }
API fmi2SetContinuousStates(fmi2Component c, const fmi2Real x[], size_t n) { (void)x; return none(c, n); }
API fmi2GetDerivatives(fmi2Component c, fmi2Real x[], size_t n) { (void)x; return none(c, n); }
API fmi2GetEventIndicators(fmi2Component c, fmi2Real x[], size_t n) { (void)x; return none(c, n); }
API fmi2GetContinuousStates(fmi2Component c, fmi2Real x[], size_t n) { (void)x; return none(c, n); }
API fmi2GetNominalsOfContinuousStates(fmi2Component c, fmi2Real x[], size_t n) { (void)x; return none(c, n); }

API fmi2SetRealInputDerivatives(fmi2Component c, ASKED, const fmi2Integer order[], const fmi2Real value[])
{
    (void)vr, (void)order, (void)value;
    return none(c, n);
}
API fmi2GetRealOutputDerivatives(fmi2Component c, ASKED, const fmi2Integer order[], fmi2Real value[])
{
    (void)vr, (void)order, (void)value;
    return none(c, n);
}
API fmi2DoStep(fmi2Component c, fmi2Real time, fmi2Real step, fmi2Boolean kept)
{
    (void)kept;
    of(c)->now.time = time + step;
    return (fmi2Status)answer(of(c));
}
API fmi2CancelStep(fmi2Component c) { (void)c; return fmi2Error; }
API fmi2GetStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Status *value)
{
    (void)kind;
    *value = (fmi2Status)answer(of(c));
    return fmi2OK;
}
API fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Real *value)
{
    *value = of(c)->now.time;
    return kind == fmi2LastSuccessfulTime ? fmi2OK : fmi2Discard;
}
API fmi2GetIntegerStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Integer *value)
{
    (void)c, (void)kind, (void)value;
    return fmi2Discard;
}
API fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Boolean *value)
{
    (void)c;
    *value = 0;
    return kind == fmi2Terminated ? fmi2OK : fmi2Discard;
}
API fmi2GetStringStatus(fmi2Component c, const fmi2StatusKind kind, fmi2String *value)
{
    (void)c, (void)kind;
    *value = "";
    return fmi2Discard;
}
