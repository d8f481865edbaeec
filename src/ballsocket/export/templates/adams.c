/* The ball joint $name as a GFORCE of Adams Solver, in mm, N, kg and s. Written by ballsocket $version.

   I is a marker at the ball's centre, RM a marker at the socket's centre and on its part, and JFLOAT a floating marker
   of that part, where the opposite force and moment act:

   GFORCE/1, I=11, JFLOAT=21, RM=20, FUNCTION=USER(0)\, ROUTINE=LIBRARY::${Name}_gforce */
#include <slv_c_utils.h>

#include "$name.h"

adams_c_Gfosub ${Name}_gforce;

void ${Name}_gforce(const struct sAdamsGforce *gforce, double time, int dflag, int iflag, double *result)
{
    const int markers[4] = {gforce->I, gforce->RM, gforce->RM, gforce->RM};
    double position[3], velocity[3], spin[3], energy;
    int count, errors[3], k, status;
    (void)time, (void)dflag, (void)iflag;
    c_sysary("TDISP", markers, 3, position, &count, &errors[0]);
    c_sysary("TVEL", markers, 4, velocity, &count, &errors[1]);
    c_sysary("RVEL", markers, 3, spin, &count, &errors[2]);
    for (k = 0; k < 3; k++)
        c_errmes(errors[k], "$name: the motion of the markers is not known", gforce->ID, "STOP");
    status = ${name}_load(&${name}_defaults, position, velocity, spin, result, result + 3, &energy);
    c_errmes(status >= ${NAME}_FAILED, ${name}_sentence(status), gforce->ID, "STOP");
}
