"""Where the methods of treadload were published: references by key, which results and steps name."""

from __future__ import annotations

from collections.abc import Iterable

CITATIONS = {
    "chain": "Materials 2021, 14(9), 2117. Approach of Pavement Surface Layer Degradation Caused by Tire Contact "
    "Using Semi-Analytical Model. doi:10.3390/ma14092117",
    "influence": "Love, A. E. H. (1929). The stress produced in a semi-infinite solid by pressure on part of the "
    "boundary. Phil. Trans. R. Soc. A 228, 377-420.",
    "convolution": "Liu, S., Wang, Q., Liu, G. (2000). A versatile method of discrete convolution and FFT (DC-FFT) "
    "for contact analyses. Wear 243, 101-111.",
    "normal": "Polonsky, I. A., Keer, L. M. (1999). A numerical method for solving rough contact problems based on "
    "the multi-level multi-summation and conjugate gradient techniques. Wear 231, 206-219.",
    "preconditioner": "Vollebregt, E. A. H. (2014). A new solver for the elastic normal contact problem using "
    "conjugate gradients, deflation, and an FFT-based preconditioner. J. Comput. Phys. 257, 333-351.",
    "rolling": "Kalker, J. J. (1990). Three-Dimensional Elastic Bodies in Rolling Contact. Kluwer.",
    "newton": "Alart, P., Curnier, A. (1991). A mixed formulation for frictional contact problems prone to Newton "
    "like solution methods. Comput. Methods Appl. Mech. Eng. 92, 353-375.",
    "splitting": "Lions, P.-L., Mercier, B. (1979). Splitting algorithms for the sum of two nonlinear operators. "
    "SIAM J. Numer. Anal. 16, 964-979.",
    "memory": "Wang, G., Knothe, K. (1993). Stress analysis for rolling contact between two viscoelastic cylinders. "
    "J. Appl. Mech. 60, 310-317.",
    "pivoting": "Júdice, J. J., Pires, F. M. (1994). A block principal pivoting algorithm for large-scale strictly "
    "monotone linear complementarity problems. Comput. Oper. Res. 21, 587-596.",
    "coupling": "Panagiotopoulos, P. D. (1975). A nonlinear programming approach to the unilateral contact- and "
    "friction-boundary value problem in the theory of elasticity. Ing. Arch. 44, 421-432.",
    "mixing": "Walker, H. F., Ni, P. (2011). Anderson acceleration for fixed-point iterations. SIAM J. Numer. Anal. "
    "49, 1715-1735.",
    "falling": "Vollebregt, E. A. H., Schuttelaars, H. M. (2012). Quasi-static analysis of two-dimensional rolling "
    "contact with slip-velocity dependent friction. J. Sound Vib. 331, 2141-2155.",
    "flash": "Jaeger, J. C. (1942). Moving sources of heat and the temperature at sliding contacts. Proc. R. Soc. "
    "N.S.W. 76, 203-224.",
    "layers": "Kennett, B. L. N. (1983). Seismic Wave Propagation in Stratified Media. Cambridge University Press, "
    "chapter 6: reflection from a stack of layers, from the bottom up.",
    "sliding": "Goodman, R. E., Taylor, R. L., Brekke, T. L. (1968). A model for the mechanics of jointed rock. J. "
    "Soil Mech. Found. Div. ASCE 94, 637-659.",
    "half-bonded": "NF P98-086 (2019). Dimensionnement structurel des chaussées routières: semi-bonded interfaces.",
    "huet": "Huet, C. (1963). Étude par une méthode d'impédance du comportement viscoélastique des matériaux "
    "hydrocarbonés. Annales des Ponts et Chaussées 6, 373-429.",
    "sayegh": "Sayegh, G. (1967). Viscoelastic properties of bituminous mixtures. Proc. 2nd Int. Conf. Structural "
    "Design of Asphalt Pavements, Ann Arbor, 743-755.",
    "2s2p1d": "Olard, F., Di Benedetto, H. (2003). General 2S2P1D model and relation between the linear viscoelastic "
    "behaviours of bituminous binders and mixes. Road Mater. Pavement Des. 4, 185-224.",
    "prony": "Park, S. W., Schapery, R. A. (1999). Methods of interconversion between linear viscoelastic material "
    "functions. Int. J. Solids Struct. 36, 1653-1675.",
    "moving": "Duhamel, D., Chabot, A., Tamagny, P., Harfouche, L. (2005). ViscoRoute: visco-elastic modeling for "
    "asphalt pavements. Bull. Lab. Ponts Chaussées 258-259, 89-103.",
    "eigenstrain": "Chiu, Y. P. (1978). On the stress field and surface deformation in a half space with a cuboidal "
    "zone in which initial strains are uniform. J. Appl. Mech. 45, 302-306.",
    "dents": "Jacq, C., Nélias, D., Lormand, G., Girodin, D. (2002). Development of a three-dimensional "
    "semi-analytical elastic-plastic contact code. J. Tribol. 124, 653-667.",
    "endless": "Stanley, H. M., Kato, T. (1997). An FFT-based method for rough surface contact. Journal of Tribology "
    "119(3), 481-485.",
    "persson": "Persson, B. N. J. (2001). Theory of rubber friction and contact mechanics. The Journal of Chemical "
    "Physics 115(8), 3840-3861.",
    "passes": "Dang Van, K., Maitournam, M. H. (1993). Steady-state flow in classical elastoplasticity: applications "
    "to repeated rolling and sliding contact. J. Mech. Phys. Solids 41, 1691-1710.",
    "inclusions": "Zhou, K., Keer, L. M., Wang, Q. J. (2011). Semi-analytic solution for multiple interacting "
    "three-dimensional inhomogeneous inclusions of arbitrary shape in an infinite space. Int. J. Numer. Methods Eng. "
    "87, 617-638.",
    "equivalence": "Eshelby, J. D. (1957). The determination of the elastic field of an ellipsoidal inclusion, and "
    "related problems. Proc. R. Soc. A 241, 376-396.",
    "miner": "Miner, M. A. (1945). Cumulative damage in fatigue. J. Appl. Mech. 12, A159-A164.",
    "grain": "Barnett, D. M., Lothe, J. (1973). Synthesis of the sextic and the integral formalism for dislocations, "
    "Green's functions and surface waves in anisotropic elastic solids. Phys. Norv. 7, 13-19.",
    "grain below": "Willis, J. R. (1966). Hertzian contact of anisotropic bodies. J. Mech. Phys. Solids 14, 163-176.",
    "upright": "Lekhnitskii, S. G. (1963). Theory of Elasticity of an Anisotropic Elastic Body. Holden-Day: loads on "
    "a half-space that is the same in all horizontal directions.",
    "upright contact": "Turner, J. R. (1980). Contact on a transversely isotropic half-space, or between two "
    "transversely isotropic bodies. Int. J. Solids Struct. 16, 409-419.",
    "blocks": "Sussman, T., Bathe, K.-J. (1987). A finite element formulation for nonlinear incompressible elastic "
    "and inelastic analysis. Comput. Struct. 26, 357-409.",
    "stress": "Johnson, K. L. (1985). Contact Mechanics. Cambridge University Press, chapter 3.",
}

SOLVED_WHOLE = ("influence", "convolution", "normal", "preconditioner", "rolling", "newton", "stress")
"""Methods of a wheel on a road, from the contact to the stresses."""
DENTS = ("influence", "convolution", "normal", "preconditioner", "eigenstrain", "dents", "mixing")
PASSES = ("eigenstrain", "passes", "mixing")
BLOCKS = ("blocks", "coupling", "mixing")
STONES = ("equivalence", "inclusions", "eigenstrain")
TEXTURE = ("endless", "normal", "persson")


def references(keys: Iterable[str]) -> list[str]:
    """References of methods, each once, behind that of the method as a whole.

    keys: of `CITATIONS`; any other text is a whole reference.
    """
    return [CITATIONS.get(key, key) for key in dict.fromkeys(("chain", *keys))]
