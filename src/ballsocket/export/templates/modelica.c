/* The ball joint $name in SI units, as Modelica calls it. Written by ballsocket $version. */
#include "ModelicaUtilities.h" /* of the Modelica tool */
#include "$name.c"

void ${name}_modelica(const double *position, const double *velocity, const double *spin, const double *tuned,
                      double *load)
{
    static const double units[$parameters] = {$units};
    double r[3], v[3], own[$parameters];
    ${name}_parameters p;
    const char *complaint;
    int k;
    for (k = 0; k < 3; k++) {
        r[k] = 1e3 * position[k];
        v[k] = 1e3 * velocity[k];
    }
    for (k = 0; k < $parameters; k++)
        own[k] = tuned[k] / units[k];
$copied
    complaint = ${name}_complaint(&p);
    if (complaint)
        ModelicaError(complaint); /* does not return */
    ${name}_load(&p, r, v, spin, load, load + 3, load + 6);
    load[9] = ${name}_contact(&p, r, load + 7, load + 8);
    for (k = 3; k < 7; k++)
        load[k] *= 1e-3;
    load[8] *= 1e6;
}
