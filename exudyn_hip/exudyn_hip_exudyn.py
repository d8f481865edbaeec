"""The ball joint exudyn_hip for Exudyn, in SI units. Written by ballsocket 1.0.0.

`add_joint` puts it between two rigid bodies; `add_hollow_sphere` puts Exudyn's own hollow sphere there, with the k and
n that come nearest to the law.
"""

import exudyn
import exudyn.itemInterface as items
import exudyn_hip as joint
import numpy as np

STIFFNESS, EXPONENT = 135607059721.97797, 1.7397154199649747
"""Best k (N/m^n) and n up to an indentation of 3.992e-05 m: at most 0.56 % of the force off."""
BALL_RADIUS, SOCKET_RADIUS = 0.0179, 0.018000000000000002


def add_joint(mbs, socket_marker, ball_marker):
    """Add a connector from a rigid marker at the socket's centre to one at the ball's centre; return its number.

    Exudyn measures the velocity in global axes and applies both forces at the markers. For a socket that moves, the
    velocity is therefore corrected to the one seen from the socket, and the torque of the lever between the two
    centres is added to the socket as a load.
    """
    quantities = exudyn.OutputVariableType
    socket = mbs.GetMarker(socket_marker)
    is_ground = "bodyNumber" in socket and mbs.GetObject(socket["bodyNumber"])["objectType"] == "Ground"

    def force_and_torque(mbs, t, item, displacement, rotation, velocity, spin, *unused):
        """Compute force and torque of the connector, which act on the first marker and reversed on the second."""
        if not is_ground:
            socket_spin = mbs.GetMarkerOutput(socket_marker, quantities.AngularVelocityLocal)
            velocity = np.asarray(velocity) - np.cross(socket_spin, displacement)
        force, moment, _ = joint.load(displacement, velocity, spin)
        return [-part for part in (*force, *moment)]

    connector = mbs.AddObject(
        items.ObjectConnectorRigidBodySpringDamper(
            markerNumbers=[socket_marker, ball_marker],
            stiffness=np.zeros((6, 6)),
            damping=np.zeros((6, 6)),
            springForceTorqueUserFunction=force_and_torque,
        )
    )

    def lever_torque(mbs, t, load):
        """Compute the torque of the force on the socket about its centre: that force acts at the ball's centre."""
        displacement = mbs.GetObjectOutput(connector, quantities.DisplacementLocal)
        force_on_socket = mbs.GetObjectOutput(connector, quantities.ForceLocal)
        axes = np.reshape(mbs.GetMarkerOutput(socket_marker, quantities.RotationMatrix), (3, 3))
        return list(axes @ np.cross(displacement, force_on_socket))

    if not is_ground:
        mbs.AddLoad(items.LoadTorqueVector(markerNumber=socket_marker, loadVectorUserFunction=lever_torque))
    return connector


def add_hollow_sphere(mbs, socket_marker, ball_marker, **words):
    """Exudyn's own contact of a sphere in a hollow one: elastic and without friction, unless `words` say more.

    `restitutionCoefficient=0.8, impactModel=2` for instance.
    """
    data = mbs.AddNode(items.NodeGenericData(initialCoordinates=[0.0] * 4, numberOfDataCoordinates=4))
    return mbs.AddObject(
        items.ObjectContactSphereSphere(
            markerNumbers=[ball_marker, socket_marker],
            nodeNumber=data,
            spheresRadii=[BALL_RADIUS, SOCKET_RADIUS],
            isHollowSphere1=True,
            contactStiffness=STIFFNESS,
            contactStiffnessExponent=EXPONENT,
            **words,
        )
    )
