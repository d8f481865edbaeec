"""Published fit of the film in point contacts, to compare with."""


def point_contact_film(viscosity, speed, force, radius, modulus):
    """Compute the central film in mm of a round isoviscous point contact by the fit of Nijenbanning, Venner and Moes.

    The fit is for bodies that hardly conform. It has the similarity of the equations, and the limits of rigid and of
    elastic bodies. Source: Wear 176 (1994) 217, doi:10.1016/0043-1648(94)90150-3. Formula and definitions were read in
    a later program, not in the paper, and the DOI was not followed (unverified).

    Parameters
    ----------
    viscosity : float
        Viscosity in MPa s.
    speed : float
        Sum of the speeds of both surfaces in mm/s.
    force : float
        Load in N.
    radius : float
        Radius of the equivalent sphere on a plane in mm.
    modulus : float
        Effective modulus E* of both bodies in MPa.
    """
    speed_number = viscosity * speed / (2 * modulus * radius)  # U of E' = 2 E*
    moes = force / (2 * modulus * radius**2) * speed_number**-0.75
    rigid = 145 * (1 + 0.796) ** (-15 / 7) * moes**-2  # H_RI of a round contact
    rigid_limit = 1.8  # H_00
    elastic = 3.18 * (1 + 0.63) ** -0.56 * moes ** (-2 / 15)  # H_EI
    height = (rigid**1.5 + (elastic**-4 + rigid_limit**-4) ** -0.375) ** (2 / 3)
    return float(radius * height * speed_number**0.5)
