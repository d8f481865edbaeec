/* A ball in its socket as a force element, written by ballsocket 1.0.0.

   model: tabulated
   joint: hip, Hess & Forsbach 2021, Fig. 3: R1 17.9 mm, clearance 0.1 mm, liner 6.75 mm of UHMWPE (E 1000 MPa, nu 0.4); ball steel head (E 230000 MPa, nu 0.3)

   Units are mm, s, rad, N, N mm, MPa. The position is that of the ball's centre from the socket's, in axes that are
   fixed to the socket. The velocity is that of the centre relative to the socket, and the spin the angular velocity of
   the ball relative to the socket. Force and moment act on the ball, the moment about its centre. The opposite force at
   the ball's centre and the opposite moment act on the socket.

   No function allocates memory, prints, stops the program or stores data between calls. Where the status is
   EXUDYN_HIP_FAILED or more there is no load: the numbers are NaN. EXUDYN_HIP_THROUGH_WALL is
   4: the indentation exceeds the wall thickness or the range of the model; the force has its last stiffness. */
#ifndef EXUDYN_HIP_H
#define EXUDYN_HIP_H

#ifdef __cplusplus
extern "C" {
#endif

/* Parameters that can be changed; see exudyn_hip_defaults and exudyn_hip_complaint. */
typedef struct exudyn_hip_parameters {
    double hysteresis; /* s/mm: damping force per contact force and speed */
    double retardation_time; /* s: retardation time of the liner */
    double friction_coefficient; /* 1: coefficient of sliding friction */
    double static_coefficient; /* 1: static coefficient of friction, at least that of sliding */
    double transition_speed; /* mm/s: slip speed at which friction reaches 71 % */
    double stribeck_speed; /* mm/s: slip speed of the transition from static to sliding friction */
    double viscous_friction; /* s/mm: viscous friction per contact force and speed */
} exudyn_hip_parameters;

enum {
    EXUDYN_HIP_FREE = 0,
    EXUDYN_HIP_CONTACT = 1,
    EXUDYN_HIP_AT_RIM = 2,
    EXUDYN_HIP_OVER_RIM = 3,
    EXUDYN_HIP_THROUGH_WALL = 4,
    EXUDYN_HIP_NO_NUMBER = 5,
    EXUDYN_HIP_BAD_PARAMETER = 6,
    EXUDYN_HIP_FAILED = 5
};

/* The parameters of the element that was exported. */
extern const exudyn_hip_parameters exudyn_hip_defaults;

/* Message on invalid parameters; 0 if all are valid. */
const char *exudyn_hip_complaint(const exudyn_hip_parameters *p);

/* Description of a status. */
const char *exudyn_hip_sentence(int status);

/* Force in N, moment in N mm, energy in N mm. Parameters are not checked. */
int exudyn_hip_load(const exudyn_hip_parameters *p, const double position[3], const double velocity[3], const double spin[3],
                 double force[3], double moment[3], double *energy);

/* Half angle of the contact in rad, its largest pressure in MPa. */
int exudyn_hip_contact(const double position[3], double *half_angle, double *max_pressure);

/* Second derivatives of the energy in N/mm, row by row: minus the derivative of the elastic force. */
int exudyn_hip_tangent(const double position[3], double tangent[9]);

/* Derivatives of force (3), moment (3), energy, half angle and largest pressure along a direction of position, velocity
   and spin. */
int exudyn_hip_slope(const exudyn_hip_parameters *p, const double position[3], const double velocity[3],
                  const double spin[3], const double way[9], double slope[9]);

#ifdef __cplusplus
}
#endif
#endif
