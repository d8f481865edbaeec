/* The ball joint $name as a passive plug-in of MuJoCo, in SI units. Written by ballsocket $version.

   An instance has two words: `ball` and `socket`, the names of sites at the two centres. */
#include <mujoco/mujoco.h>

#include "$name.h"

#define STIFFNESS $stiffness /* N/m: the largest one up to the indentation of the export */
enum { WALL = 1, LONG_STEP = 2 }; /* warnings that were given */

static int site(const mjModel *m, int instance, const char *word)
{
    const char *name = mj_getPluginConfig(m, instance, word);
    return name ? mj_name2id(m, mjOBJ_SITE, name) : -1;
}

static int no_state(const mjModel *m, int instance) { (void)m, (void)instance; return 0; }

static int begin(const mjModel *m, mjData *d, int instance)
{
    if (site(m, instance, "ball") < 0 || site(m, instance, "socket") < 0) {
        mju_warning("ballsocket.$name: `ball` and `socket` must be the names of sites");
        return -1;
    }
    d->plugin_data[instance] = 0;
    return 0;
}

/* Warn once of a time step above 2 sqrt(mass/k): an integration with it gains energy in contact. */
static void warn_of_a_long_step(const mjModel *m, mjData *d, int instance, mjtNum mass)
{
    if (m->opt.timestep * m->opt.timestep * STIFFNESS <= 4.0 * mass || d->plugin_data[instance] & LONG_STEP)
        return;
    d->plugin_data[instance] |= LONG_STEP;
    mju_warning("ballsocket.$name: the time step %g s is above the largest stable one, %.2g s: reduce it",
                m->opt.timestep, 2.0 * mju_sqrt(mass / STIFFNESS));
}

static void compute(const mjModel *m, mjData *d, int instance, int capability)
{
    const int ball = site(m, instance, "ball"), socket = site(m, instance, "socket");
    const mjtNum *centre = d->site_xpos + 3 * ball, *turn = d->site_xmat + 9 * socket;
    mjtNum moving[6], held[6], r[3], v[3], w[3], f[3], t[3], force[3], moment[3], back[3], arm[3], turned[3], energy;
    int k, status;
    (void)capability;
    mj_objectVelocity(m, d, mjOBJ_SITE, ball, moving, 0);
    mj_objectVelocity(m, d, mjOBJ_SITE, socket, held, 0);
    mju_sub3(arm, centre, d->site_xpos + 3 * socket);
    mju_cross(turned, held, arm);
    for (k = 0; k < 3; k++) {
        moving[3 + k] -= held[3 + k] + turned[k];
        moving[k] -= held[k];
    }
    mju_mulMatTVec3(r, turn, arm);
    mju_mulMatTVec3(v, turn, moving + 3);
    mju_mulMatTVec3(w, turn, moving);
    mju_scl3(r, r, 1e3);
    mju_scl3(v, v, 1e3);
    status = ${name}_load(&${name}_defaults, r, v, w, f, t, &energy);
    if (status >= ${NAME}_THROUGH_WALL && !(d->plugin_data[instance] & WALL)) {
        d->plugin_data[instance] |= WALL;
        mju_warning("ballsocket.$name: %s, at %g s", ${name}_sentence(status), d->time);
    }
    warn_of_a_long_step(m, d, instance, m->body_mass[m->site_bodyid[ball]]);
    if (status >= ${NAME}_FAILED)
        return;
    mju_mulMatVec3(force, turn, f);
    mju_mulMatVec3(moment, turn, t);
    mju_scl3(moment, moment, 1e-3);
    mj_applyFT(m, d, force, moment, centre, m->site_bodyid[ball], d->qfrc_passive);
    mju_scl3(back, force, -1.0);
    mju_scl3(moment, moment, -1.0);
    mj_applyFT(m, d, back, moment, centre, m->site_bodyid[socket], d->qfrc_passive);
}

mjPLUGIN_LIB_INIT(ballsocket_$name)
{
    static const char *words[] = {"ball", "socket"};
    mjpPlugin plugin;
    mjp_defaultPlugin(&plugin);
    plugin.name = "ballsocket.$name";
    plugin.nattribute = 2;
    plugin.attributes = words;
    plugin.capabilityflags = mjPLUGIN_PASSIVE;
    plugin.nstate = no_state;
    plugin.init = begin;
    plugin.compute = compute;
    mjp_registerPlugin(&plugin);
}
