/* Calls a user force as Simpack does, and answers what it asks for. */
#include <string.h>
double motion[9], force[3], torque[3], ov[3]; int sizes[5], kinds[2], refused = 0;
void spck_df_fclass_(const int *kind, int *error) { sizes[0] = *kind, *error = 0; }
void spck_df_forcepardim_(const int *size, int *error) { sizes[1] = *size, *error = 0; }
void spck_df_forcestdyndim_(const int *size, int *error) { sizes[2] = *size, *error = 0; }
void spck_df_forceovdim_(const int *size, int *error) { sizes[3] = *size, *error = 0; }
void spck_df_forcerefsys_(const int *system, int *error) { sizes[4] = *system, *error = 0; }
static int seen(double *out, int first, const int *to, const int *from, const int *reference)
{
    memcpy(out, motion + first, 3 * sizeof(double));
    return refused || *to != 22 || *from != 11 || *reference != 11;
}
void spck_av_dxyz_(double *d, double *out, int *to, int *from, int *ref, int *error)
{
    *error = seen(out, 0, to, from, ref);
}
void spck_av_vxyz_(double *v, double *rate, double *out, int *to, int *from, int *by, int *ref, int *error)
{
    *error = seen(out, 3, to, from, ref) || *by != 11;
}
void spck_av_wxyz_(double *w, double *out, int *to, int *from, int *ref, int *error)
{
    *error = seen(out, 6, to, from, ref);
}
typedef int *I;
typedef double *D;
typedef char *C;
typedef size_t Length;
void uforce20_type_(I, C, I, Length);
void uforce20_setup_(I, I, I, I, I, I, I, I, D, I, C, I, C, I, C, I, I, I, I, I, I, Length, Length, Length);
void uforce20_(I, I, I, I, I, I, I, D, I, I, D, D, D, I, D, D, D, D, D, I);
int call(void)
{
    static char name[30], names[90];
    int length = 30, none = 0, outputs = 3, id = 1, from = 11, to = 22, error = 0, task, units[3], unused;
    double time = 0.0, nothing[1];
    uforce20_type_(&length, name, &error, 30);
    for (task = 0; task < 2 && !error; task++)
        uforce20_setup_(&task, &none, &none, &outputs, &length, &id, &from, &to, nothing, &unused, name, &unused, name,
                        &unused, names, units, &kinds[0], &unused, &unused, &kinds[1], &error, 30, 30, 30);
    task = 0;
    if (!error && !memcmp(names + 30, "largest pressure, Pa", 20))
        uforce20_(&task, &none, &none, &none, &none, &outputs, &id, nothing, &from, &to, &time, nothing, nothing,
                  &unused, nothing, force, torque, ov, nothing, &error);
    return error;
}
