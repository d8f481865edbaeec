/* Written by ballsocket $version; see the header.

   model: $model
   joint: $joint */
#include <math.h>

#include "$name.h"

$along
$curves
const ${name}_parameters ${name}_defaults = {$defaults};

const char *${name}_complaint(const ${name}_parameters *p)
{
$checks
    return 0;
}

const char *${name}_sentence(int status)
{
    switch (status) {
$sentences
    case ${NAME}_BAD_PARAMETER: return "a parameter is not allowed";
    }
    return "an unknown status";
}

/* Return 1 if 1e8 times the square of a vector is finite, else 0. */
static int is_finite(const double v[3])
{
    return 1e8 * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) < INFINITY;
}

static int fill(double *numbers, int count, double value, int status)
{
    while (count-- > 0)
        *numbers++ = value;
    return status;
}

/* Return 1 if there is no contact, else 0; the formulas cover the centre. */
static int apart(const ${name}_parameters *p, const double position[3])
{
    const double x = position[0], y = position[1], z = position[2], square = x * x + y * y + z * z;
    double unloaded;
    (void)p;
$unloaded
    return square > 0.0 && unloaded > 0.0 && square <= unloaded * unloaded;
}

int ${name}_load(const ${name}_parameters *p, const double position[3], const double velocity[3],
                 const double spin[3]$internal, double force[3], double moment[3], double *energy$rate)
{
    int status;
    if (!is_finite(position) || !is_finite(velocity) || !is_finite(spin)$not_finite) {
        fill(force, 3, NAN, 0);
        fill(moment, 3, NAN, 0);$no_rate
        return fill(energy, 1, NAN, ${NAME}_NO_NUMBER);
    }
    if (apart(p, position)) {
        fill(force, 3, 0.0, 0);
        fill(moment, 3, 0.0, 0);
        return fill(energy, 1, 0.0, ${NAME}_FREE);
    }
$load
    return status;
}

int ${name}_contact(const ${name}_parameters *p, const double position[3], double *half_angle, double *max_pressure)
{
    int status;
    (void)p;
    if (!is_finite(position)) {
        fill(half_angle, 1, NAN, 0);
        return fill(max_pressure, 1, NAN, ${NAME}_NO_NUMBER);
    }
$pressed
    return status;
}

int ${name}_valid(const ${name}_parameters *p, const double position[3])
{
    int valid;
    (void)p;
    if (!is_finite(position))
        return 0;
$valid
    return valid;
}

int ${name}_tangent(const ${name}_parameters *p, const double position[3]$liner, double tangent[9])
{
    int status;
    (void)p;
    if (!is_finite(position)$liner_not_finite)
        return fill(tangent, 9, NAN, ${NAME}_NO_NUMBER);
    if (apart(p, position))
        return fill(tangent, 9, 0.0, ${NAME}_FREE);
$tangent
    return status;
}

int ${name}_slope(const ${name}_parameters *p, const double position[3], const double velocity[3],
                  const double spin[3]$internal, const double way[$count], double slope[$count])
{
    int status;
    if (!is_finite(position) || !is_finite(velocity) || !is_finite(spin)$not_finite
        || !is_finite(way) || !is_finite(way + 3) || !is_finite(way + 6))
        return fill(slope, $count, NAN, ${NAME}_NO_NUMBER);
    if (apart(p, position))
        return fill(slope, $count, 0.0, ${NAME}_FREE);
$slope
    return status;
}
