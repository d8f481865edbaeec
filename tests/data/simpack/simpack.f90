! Constants of Simpack that a user force uses; their values stand for those of Simpack.
module simpack
    integer, parameter :: fclass_force = 1, knodef = 2, kforce_res_force_torque = 3, kforce_strst_none = 4
    integer, parameter :: kref_marker = 5
end module
