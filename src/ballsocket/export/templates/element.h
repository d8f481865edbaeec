/* A ball in its socket as a force element, written by ballsocket $version.

   model: $model
   joint: $joint

   Units are mm, s, rad, N, N mm, MPa. The position is that of the ball's centre from the socket's, in axes that are
   fixed to the socket. The velocity is that of the centre relative to the socket, and the spin the angular velocity of
   the ball relative to the socket. Force and moment act on the ball, the moment about its centre. The opposite force at
   the ball's centre and the opposite moment act on the socket.

   No function allocates memory, prints, stops the program or stores data between calls. Where the status is
   ${NAME}_FAILED or more there is no load: the numbers are NaN. ${NAME}_THROUGH_WALL is
   $through_wall. */
#ifndef ${NAME}_H
#define ${NAME}_H

#ifdef __cplusplus
extern "C" {
#endif

/* Parameters that can be changed; see ${name}_defaults and ${name}_complaint. */
typedef struct ${name}_parameters {
$fields
} ${name}_parameters;

enum {
$codes
    ${NAME}_BAD_PARAMETER = 6,
    ${NAME}_FAILED = $failed
};

/* The parameters of the element that was exported. */
extern const ${name}_parameters ${name}_defaults;

/* Message on invalid parameters; 0 if all are valid. */
const char *${name}_complaint(const ${name}_parameters *p);

/* Description of a status. */
const char *${name}_sentence(int status);

/* Force in N, moment in N mm, energy in N mm. Parameters are not checked.$state_units */
int ${name}_load(const ${name}_parameters *p, const double position[3], const double velocity[3],
                 const double spin[3]$internal, double force[3], double moment[3], double *energy$rate);

/* Half angle of the contact in rad, its largest pressure in MPa. */
int ${name}_contact(const ${name}_parameters *p, const double position[3], double *half_angle, double *max_pressure);

/* 1 where the model is valid at the indentation, else 0. The ratio of von Mises stress to largest pressure stays that
   of the exported thickness. */
int ${name}_valid(const ${name}_parameters *p, const double position[3]);

/* Tangent stiffness in N/mm, row by row: minus the derivative of the elastic force, at constant internal states. */
int ${name}_tangent(const ${name}_parameters *p, const double position[3]$liner, double tangent[9]);

/* Derivatives of force (3), moment (3), energy, half angle and largest pressure along a direction of position, velocity
   and spin.$state_slopes */
int ${name}_slope(const ${name}_parameters *p, const double position[3], const double velocity[3],
                  const double spin[3]$internal, const double way[$count], double slope[$count]);

#ifdef __cplusplus
}
#endif
#endif
