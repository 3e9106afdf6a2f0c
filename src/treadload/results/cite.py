"""Which methods a result actually used, and where they were published."""

from __future__ import annotations

from treadload.case import LifeCase
from treadload.case.file import FilePart
from treadload.contact import Contact
from treadload.materials import HuetSayegh, Model2S2P1D, Orthotropic, Prony, TransverselyIsotropic
from treadload.pavement import BONDED, HALF_BONDED, Pavement
from treadload.response import Response

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
    "stress": "Johnson, K. L. (1985). Contact Mechanics. Cambridge University Press, chapter 3.",
}


def citations(contact: Contact | None, response: Response | None, road: Pavement | None = None) -> list[str]:
    """References of the methods that these results actually used; road: of the response."""
    used = ["chain"]
    if contact is not None:
        used += ["influence", "convolution", "normal", "preconditioner", "rolling", "newton"]
        if contact.stats.get("splitting_iterations"):
            used.append("splitting")
        if contact.stats.get("coupling_rounds", 1) > 1:
            used += ["coupling", "mixing"]
        if contact.rolling.law.needs_speed:
            used.append("falling")
        if "flash_temperature" in contact.dataset:
            used.append("flash")
        if isinstance(contact.tire.material, Orthotropic) or _has_grain(contact.road):
            used.append("grain")
        if isinstance(contact.road.layers[0].material, TransverselyIsotropic):
            used.append("upright contact")
        if isinstance(contact.tire.material, Prony):
            used += ["memory", "pivoting"]
    if response is not None:
        used += [key for key in ("influence", "convolution", "stress") if key not in used]
        used += _of_the_road(road if road is not None or contact is None else contact.road)
    return [CITATIONS[key] for key in used]


def _has_grain(road: Pavement) -> bool:
    """Whether the surface of a road is stiffer in some horizontal directions than in others, or its axes lean."""
    return isinstance(road.layers[0].material, Orthotropic)


def _of_the_road(road: Pavement | None) -> list[str]:
    """Keys of the methods that a road calls for."""
    if road is not None and _has_grain(road):
        return ["grain below"]
    if road is None:
        return []
    upright = ["upright"] if any(isinstance(one.material, TransverselyIsotropic) for one in road.layers) else []
    if road.is_homogeneous and not road.is_viscoelastic:
        return upright
    bonds = [layer.bond for layer in road.layers[:-1]]
    materials = [layer.resolved for layer in road.layers]
    asked = {
        "layers": not road.is_homogeneous,
        "sliding": any(bond != BONDED for bond in bonds),
        "half-bonded": HALF_BONDED in bonds,
        "moving": road.is_viscoelastic,
        "huet": any(isinstance(one, HuetSayegh | Model2S2P1D) for one in materials),
        "sayegh": any(isinstance(one, HuetSayegh) for one in materials),
        "2s2p1d": any(isinstance(one, Model2S2P1D) for one in materials),
        "prony": any(isinstance(one, Prony) for one in materials),
    }
    return [*(key for key, used in asked.items() if used), *upright]


def passes_citations() -> list[str]:
    """References of the methods that passes over a road that yields use beside those of its response."""
    return [CITATIONS[key] for key in ("eigenstrain", "passes", "mixing")]


def dents_citations() -> list[str]:
    """References of the methods that a body in a road that yields uses."""
    return [
        CITATIONS[key]
        for key in ("influence", "convolution", "normal", "preconditioner", "eigenstrain", "dents", "mixing")
    ]


def stones_citations() -> list[str]:
    """References of the methods that stones in mortar use beside those of the response."""
    return [CITATIONS[key] for key in ("equivalence", "inclusions", "eigenstrain")]


def texture_citations() -> list[str]:
    """References of the methods that rubber on texture uses."""
    return [CITATIONS[key] for key in ("endless", "normal", "persson")]


_ANY_TEMPERATURE = 15.0
# Of every case that is solved whole.
_WHOLE = ("chain", "influence", "convolution", "normal", "preconditioner", "rolling", "newton", "stress")


def life_citations(road: Pavement | None) -> list[str]:
    """References of the methods that a life on this road uses."""
    return [CITATIONS[key] for key in [*_WHOLE, *_of_the_road(road), "miner"]]


def case_citations(case: FilePart) -> list[str]:
    """References of the methods that a study of a case uses, before any of it is solved."""
    miner = ["miner"] if isinstance(case, LifeCase) else []
    road = case.build_road()
    # A road of mixes waits for the temperatures of its seasons; the methods are the same at all of them.
    road = None if road is None else road.at_temperature(_ANY_TEMPERATURE, extrapolate=True)
    return [CITATIONS[key] for key in [*_WHOLE, *_of_the_road(road), *miner]]
