/* The ball joint $name as a force of OpenSim with friction, rim and outputs, in SI units.
   Written by ballsocket $version.

   frame1 is fixed to the socket, at its centre; frame2 to the ball, at its centre. Compile with the headers of the SDK:

     cc -O2 -fPIC -c $name.c
     c++ -O2 -fPIC -shared -std=c++20 -I SDK/include ${name}_opensim.cpp $name.o -o lib${name}.so

   Python loads it by opensim.LoadOpenSimLibraryExact("lib${name}.so") before a model with a ${Name}Joint is read. */
#include <OpenSim/Simulation/Model/ForceConsumer.h>
#include <OpenSim/Simulation/Model/ForceProducer.h>
#include <OpenSim/Simulation/Model/PhysicalFrame.h>
#include <OpenSim/Simulation/Model/TwoFrameLinker.h>

#include "$name.h"

using SimTK::State;
using SimTK::Vec3;

class ${Name}Joint : public OpenSim::TwoFrameLinker<OpenSim::ForceProducer, OpenSim::PhysicalFrame> {
    OpenSim_DECLARE_CONCRETE_OBJECT(${Name}Joint, TwoFrameLinker);

public:
    OpenSim_DECLARE_OUTPUT(force, Vec3, getForce, SimTK::Stage::Velocity); /* on the ball, in axes of the socket */
    OpenSim_DECLARE_OUTPUT(moment, Vec3, getMoment, SimTK::Stage::Velocity);
    OpenSim_DECLARE_OUTPUT(half_angle, double, getHalfAngle, SimTK::Stage::Velocity);
    OpenSim_DECLARE_OUTPUT(max_pressure, double, getMaxPressure, SimTK::Stage::Velocity);
    OpenSim_DECLARE_OUTPUT(area, double, getArea, SimTK::Stage::Velocity);
    OpenSim_DECLARE_OUTPUT(status, double, getStatus, SimTK::Stage::Velocity);

    Vec3 getForce(const State& s) const { return solve(s).force; }
    Vec3 getMoment(const State& s) const { return solve(s).moment; }
    double getHalfAngle(const State& s) const { return solve(s).half_angle; }
    double getMaxPressure(const State& s) const { return solve(s).max_pressure; }
    double getArea(const State& s) const {
        return 2.0 * SimTK::Pi * $ball_radius * $ball_radius * (1.0 - std::cos(solve(s).half_angle));
    }
    double getStatus(const State& s) const { return solve(s).status; }
    double computePotentialEnergy(const State& s) const override { return solve(s).energy; }

private:
    struct Solution { Vec3 force, moment; double energy, half_angle, max_pressure; int status; };

    Solution solve(const State& s) const {
        const auto &turn = getFrame1().getTransformInGround(s).R();
        const auto &held = getFrame1().getVelocityInGround(s), &moving = getFrame2().getVelocityInGround(s);
        const Vec3 arm = getFrame2().getPositionInGround(s) - getFrame1().getPositionInGround(s);
        const Vec3 w = ~turn * (moving[0] - held[0]);
        const Vec3 r = 1e3 * (~turn * arm), v = 1e3 * (~turn * (moving[1] - held[1] - held[0] % arm));
        const auto* p = &${name}_defaults;
        Solution found;
        found.status = ${name}_load(p, &r[0], &v[0], &w[0], &found.force[0], &found.moment[0], &found.energy);
        OPENSIM_THROW_IF_FRMOBJ(found.status >= ${NAME}_FAILED, OpenSim::Exception, ${name}_sentence(found.status));
        ${name}_contact(p, &r[0], &found.half_angle, &found.max_pressure);
        found.moment *= 1e-3;
        found.energy *= 1e-3;
        found.max_pressure *= 1e6;
        return found;
    }

    void implProduceForces(const State& s, OpenSim::ForceConsumer& consumer) const override {
        const auto &pose = getFrame1().getTransformInGround(s);
        const Solution found = solve(s);
        const Vec3 force = pose.R() * found.force, moment = pose.R() * found.moment;
        consumer.consumePointForce(s, getFrame2(), Vec3(0.0), force);
        consumer.consumeTorque(s, getFrame2(), moment);
        consumer.consumePointForce(s, getFrame1(), ~pose * getFrame2().getPositionInGround(s), -force);
        consumer.consumeTorque(s, getFrame1(), -moment);
    }
};

extern "C" const int ${name}_registered = (OpenSim::Object::registerType(${Name}Joint()), 1);
