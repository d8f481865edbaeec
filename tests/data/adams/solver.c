/* A solver of a few lines that calls a GFOSUB through the published interface. */
#include <string.h>
#include "slv_c_utils.h"
double motion[9]; int stopped = 0;
void c_sysary(const char *name, const int *markers, int size, double *values, int *count, int *error)
{
    const int speed = strcmp(name, "TVEL") == 0, spin = strcmp(name, "RVEL") == 0;
    *error = markers[0] != 11 || markers[1] != 20 || markers[2] != 20 || size != 3 + speed;
    memcpy(values, motion + 3 * speed + 6 * spin, 3 * sizeof(double));
    *count = 3;
}
void c_errmes(int error, const char *text, int id, const char *action)
{
    (void)text, (void)id;
    stopped |= error && strcmp(action, "STOP") == 0;
}
adams_c_Gfosub Hip_gforce;
void call(double *result)
{
    const struct sAdamsGforce gforce = {1, 0, 0, 11, 20, 21};
    Hip_gforce(&gforce, 0.0, 0, 0, result);
}
