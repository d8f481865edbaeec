! The ball joint $name as user force element type 20 of Simpack, in SI units. Written by ballsocket $version.
!
! The from-marker is at the socket's centre, on its body, and the to-marker at the ball's centre. Simpack applies the
! opposite force and torque to the to-marker, and the torque of the lever to the from-marker. Compile it with $name.c.
! For another type number replace uforce20.
module ${name}_in_c
    use iso_c_binding, only: c_int, c_double
    implicit none
    real(c_double), bind(C, name="${name}_defaults") :: defaults($parameters)
    interface
        integer(c_int) function load(p, position, velocity, spin, force, moment, energy) bind(C, name="${name}_load")
            import :: c_int, c_double
            real(c_double), intent(in) :: p(*), position(3), velocity(3), spin(3)
            real(c_double), intent(out) :: force(3), moment(3), energy
        end function
        integer(c_int) function contact(p, position, half_angle, max_pressure) bind(C, name="${name}_contact")
            import :: c_int, c_double
            real(c_double), intent(in) :: p(*), position(3)
            real(c_double), intent(out) :: half_angle, max_pressure
        end function
    end interface
end module

subroutine uforce20_type(str_dim, type_name, ierr)
    use simpack
    implicit none
    integer, intent(in) :: str_dim
    integer, intent(out) :: ierr
    character(len=*), intent(out) :: type_name
    type_name = 'Ball joint $name'
    call spck_df_FClass(fclass_force, ierr)
    if (ierr == 0) call spck_df_ForceParDim(0, ierr)
    if (ierr == 0) call spck_df_ForceStDynDim(0, ierr)
    if (ierr == 0) call spck_df_ForceOvDim(3, ierr)
end subroutine

subroutine uforce20_setup(task, par_dim, stdyn_dim, ov_dim, str_dim, id, mk_from, mk_to, par, par_type, par_name, &
        par_unit, stdyn_name, stdyn_unit, ov_name, ov_unit, res_type, stdyn_nr, stroot_nr, strst_type, ierr)
    use simpack
    implicit none
    integer, intent(in) :: task, par_dim, stdyn_dim, ov_dim, str_dim, id, mk_from, mk_to
    integer :: par_type(par_dim), par_unit(par_dim), stdyn_unit(stdyn_dim), ov_unit(ov_dim), stdyn_nr, stroot_nr
    integer :: res_type, strst_type, ierr
    double precision :: par(par_dim)
    character(len=*) :: par_name(par_dim), stdyn_name(stdyn_dim), ov_name(ov_dim)
    ierr = 0
    if (task == 0) then
        ov_name(1:3) = [character(len=20) :: 'half angle, rad', 'largest pressure, Pa', 'status']
        ov_unit = knodef
    else if (task == 1) then
        res_type = kforce_res_force_torque
        strst_type = kforce_strst_none
        call spck_df_ForceRefSys(kref_marker, ierr)
    end if
end subroutine

subroutine uforce20(task, par_dim, uin_dim, stdyn_dim, stroot_dim, ov_dim, id, par, mk_from, mk_to, time, uin, stdyn, &
        stroot, stdynd, force, torque, ov, valroot, ierr)
    use simpack
    use ${name}_in_c
    implicit none
    integer :: task, par_dim, uin_dim, stdyn_dim, stroot_dim, ov_dim, id, mk_from, mk_to, stroot(stroot_dim), ierr
    double precision :: par(par_dim), time, uin(uin_dim), stdyn(stdyn_dim), stdynd(stdyn_dim), force(3), torque(3)
    double precision :: ov(ov_dim), valroot(stroot_dim), length, rate, position(3), velocity(3), spin(3), energy
    ierr = 0
    if (task /= 0) return
    call spck_av_dxyz(length, position, mk_to, mk_from, mk_from, ierr)
    if (ierr == 0) call spck_av_vxyz(length, rate, velocity, mk_to, mk_from, mk_from, mk_from, ierr)
    if (ierr == 0) call spck_av_wxyz(length, spin, mk_to, mk_from, mk_from, ierr)
    if (ierr /= 0) return
    position = 1d3 * position
    if (load(defaults, position, 1d3 * velocity, spin, force, torque, energy) >= $failed) ierr = 1
    force = -force
    torque = -1d-3 * torque
    ov(3) = contact(defaults, position, ov(1), ov(2))
    ov(2) = 1d6 * ov(2)
end subroutine
