within ;
package $name "A ball in its socket as a force element. Written by ballsocket $version; model: $model"

  function load "Force, moment and energy at a state, from the C program beside this file"
    input Real position[3](each unit="m");
    input Real velocity[3](each unit="m/s");
    input Real spin[3](each unit="rad/s");
    input Real parameters[$parameters] "$tunables, in SI units";
    output Real load[10] "force (N), moment (N.m), energy (J), half angle (rad), largest pressure (Pa), status";
  external "C" ${name}_modelica(position, velocity, spin, parameters, load)
    annotation(Include="#include \"${name}_modelica.c\"");
  annotation(smoothOrder=1);
  end load;

  model Joint "frame_a is fixed to the socket, at its centre; frame_b to the ball, at its centre"
    extends Modelica.Mechanics.MultiBody.Interfaces.PartialTwoFrames;
    import Modelica.Mechanics.MultiBody.Frames;
$declared
    Modelica.Units.SI.Position position[3](each start=0) "of the ball's centre, in frame_a";
    Modelica.Units.SI.Velocity velocity[3];
    Modelica.Units.SI.AngularVelocity spin[3];
    Modelica.Units.SI.Force force[3] "on the ball, in frame_a";
    Modelica.Units.SI.Torque moment[3] "on the ball, in frame_a";
    Modelica.Units.SI.Energy energy;
    Modelica.Units.SI.Angle half_angle;
    Modelica.Units.SI.Pressure max_pressure;
    Real status "$through_wall";
  protected
    Real answer[10];
    Frames.Orientation turn = Frames.relativeRotation(frame_a.R, frame_b.R);
  equation
    position = Frames.resolve2(frame_a.R, frame_b.r_0 - frame_a.r_0);
    velocity = der(position);
    spin = Frames.resolve1(turn, Frames.angularVelocity2(turn));
    answer = load(position, velocity, spin, {$names});
    force = answer[1:3];
    moment = answer[4:6];
    energy = answer[7];
    half_angle = answer[8];
    max_pressure = answer[9];
    status = answer[10];
    frame_b.f = -Frames.resolve2(turn, force);
    frame_b.t = -Frames.resolve2(turn, moment);
    frame_a.f = force;
    frame_a.t = moment + cross(position, force);
  end Joint;
  annotation(uses(Modelica(version="4.0.0")));
end $name;
