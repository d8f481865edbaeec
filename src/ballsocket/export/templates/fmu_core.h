/* What both versions of the interface share: an element with its inputs, outputs and parameters in SI units.
   Value references: 0 the time, 1..9 position, velocity and spin, 10..18 force, moment, energy, half angle and largest
   pressure, 19..25 the parameters. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "$name.h"

#if defined _WIN32
#define EXPORTED __declspec(dllexport)
#else
#define EXPORTED
#endif

enum { INPUTS = 9, OUTPUTS = 9, PARAMETERS = $parameters, VARIABLES = 1 + INPUTS + OUTPUTS + PARAMETERS };
enum { GOOD, WARNING, DISCARD, ERROR }; /* as in both standards */

/* The numbers of an instance; there are no states. */
typedef struct {
    double time, input[INPUTS], parameter[PARAMETERS];
} memory;

typedef struct core {
    memory now;
    double output[OUTPUTS];
    int fresh, failed, said[4];
    void (*say)(struct core *c, int level, const char *message);
} core;

/* One of the element's units in that of the interface. */
static const double input_unit[INPUTS] = {1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1.0, 1.0, 1.0};
static const double output_unit[OUTPUTS] = {1.0, 1.0, 1.0, 1e-3, 1e-3, 1e-3, 1e-3, 1.0, 1e6};
static const double parameter_unit[PARAMETERS] = {$units};

static void begin(core *c)
{
    const double defaults[PARAMETERS] = {$starts};
    memset(&c->now, 0, sizeof c->now);
    memcpy(c->now.parameter, defaults, sizeof defaults);
    memset(c->said, 0, sizeof c->said);
    c->fresh = 0;
}

/* Of each level one message: not one at each step. */
static int tell(core *c, int level, const char *message)
{
    if (!c->said[level]++)
        c->say(c, level, message);
    return level;
}

static void own_units(const core *c, double state[INPUTS], ${name}_parameters *p)
{
    double tuned[PARAMETERS];
    int k;
    for (k = 0; k < INPUTS; k++)
        state[k] = c->now.input[k] / input_unit[k];
    for (k = 0; k < PARAMETERS; k++)
        tuned[k] = c->now.parameter[k] / parameter_unit[k];
    memcpy(p, tuned, sizeof *p);
}

static int told(core *c, int status, const double position[3])
{
    const double *r = position;
    char text[300];
    if (status < ${NAME}_THROUGH_WALL) {
        if (sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]) > $valid)
            tell(c, WARNING, "$beyond");
        return GOOD;
    }
    snprintf(text, sizeof text, "%s; position (%g, %g, %g) mm, time %g s", ${name}_sentence(status), r[0], r[1], r[2],
             c->now.time);
    return tell(c, status == ${NAME}_THROUGH_WALL ? DISCARD : ERROR, text);
}

/* The outputs at the inputs. */
static int answer(core *c)
{
    double state[INPUTS], *y = c->output;
    const char *complaint;
    ${name}_parameters p;
    int k, status;
    if (c->fresh)
        return c->failed;
    c->fresh = 1;
    own_units(c, state, &p);
    complaint = ${name}_complaint(&p);
    status = ${name}_load(&p, state, state + 3, state + 6, y, y + 3, y + 6);
    ${name}_contact(state, y + 7, y + 8);
    for (k = 0; k < OUTPUTS; k++)
        y[k] = complaint ? NAN : y[k] * output_unit[k];
    return c->failed = complaint ? tell(c, ERROR, complaint) : told(c, status, state);
}

static int unknown(core *c)
{
    return tell(c, ERROR, "there is no number with this value reference that could be asked for, or set");
}

static int get_numbers(core *c, const unsigned *references, size_t count, double *values)
{
    int worst = GOOD, status;
    size_t k;
    for (k = 0; k < count; k++) {
        const unsigned number = references[k];
        if (number >= VARIABLES)
            return unknown(c);
        if (number > INPUTS && number <= INPUTS + OUTPUTS && (status = answer(c)) > worst)
            worst = status;
        values[k] = number == 0                  ? c->now.time
                    : number <= INPUTS           ? c->now.input[number - 1]
                    : number <= INPUTS + OUTPUTS ? c->output[number - 1 - INPUTS]
                                                 : c->now.parameter[number - 1 - INPUTS - OUTPUTS];
    }
    return worst;
}

static int set_numbers(core *c, const unsigned *references, size_t count, const double *values)
{
    size_t k;
    for (k = 0; k < count; k++) {
        const unsigned number = references[k];
        if (number == 0 || (number > INPUTS && number <= INPUTS + OUTPUTS) || number >= VARIABLES)
            return unknown(c);
        if (number <= INPUTS)
            c->now.input[number - 1] = values[k];
        else
            c->now.parameter[number - 1 - INPUTS - OUTPUTS] = values[k];
    }
    c->fresh = 0;
    return GOOD;
}

/* How all outputs change along a way of the inputs. */
static int slopes_along(core *c, const double way[INPUTS], double slope[OUTPUTS])
{
    double state[INPUTS], scaled[INPUTS];
    ${name}_parameters p;
    int k, status;
    own_units(c, state, &p);
    for (k = 0; k < INPUTS; k++)
        scaled[k] = way[k] / input_unit[k];
    status = ${name}_slope(&p, state, state + 3, state + 6, scaled, slope);
    for (k = 0; k < OUTPUTS; k++)
        slope[k] *= output_unit[k];
    return told(c, status, state);
}

static int is_input(unsigned number) { return number > 0 && number <= INPUTS; }
static int is_output(unsigned number) { return number > INPUTS && number <= INPUTS + OUTPUTS; }

static int directional(core *c, const unsigned *unknowns, size_t many, const unsigned *knowns, size_t known,
                       const double *seed, double *sensitivity)
{
    double way[INPUTS] = {0.0}, slope[OUTPUTS];
    int status;
    size_t k;
    for (k = 0; k < known; k++) {
        if (!is_input(knowns[k]))
            return unknown(c);
        way[knowns[k] - 1] = seed[k];
    }
    status = slopes_along(c, way, slope);
    for (k = 0; k < many; k++) {
        if (!is_output(unknowns[k]))
            return unknown(c);
        sensitivity[k] = slope[unknowns[k] - 1 - INPUTS];
    }
    return status;
}

