"""The texture of a case's road, and the rubber that touches it."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, ClassVar

from pydantic import model_validator

from treadload.case.description import Description
from treadload.case.step import Step
from treadload.citations import TEXTURE
from treadload.contact import Contact, Enveloped, TextureContact, solve_texture
from treadload.contact.relief import check_step
from treadload.errors import positive
from treadload.materials import Elastic, Prony
from treadload.pavement import Texture
from treadload.pavement import texture as textures
from treadload.read import Choice
from treadload.registry import MATERIALS
from treadload.steps.outline import Outline
from treadload.steps.scene import Scene
from treadload.units import Length, Number

RUBBER = Choice(MATERIALS, "rubber of the tread", only=(Elastic, Prony))
_OF_PATCH = ("rubber", "thickness", "wave")
_SPECTRUM = ("size", "hurst", "roll_off", "rms_height", "rms_slope", "seed")


class TextureStep(Step, name="texture"):
    """`[texture]`: the road's texture below the tread, in one of two ways.

    A patch of it that stands for all, under the pressures of the wheel on a plane, `treadload.contact.solve_texture`;
    or resolved, on the cells of the contact, `treadload.solve_contact(relief=...)`.

    resolved: true to put the texture under the whole tire, which then rolls on its peaks; its points lie no further
    apart than the cells. enveloping: of a resolved texture, the length over which the pressure on peaks is spread
    before it loads the layers; half the first depth that is read, or less; left out, the peaks load the layers.
    rubber: of the tread, its own; a viscoelastic one is read at the speed over `wave`; of a patch, not of a resolved
    texture, which meets the tire of the case. thickness: of the tread on its belt; left out, deep. wave: by which a
    speed becomes a frequency; left out, the texture's mean one.
    file: a texture as it was measured; its drop-outs are filled, its outliers taken out, and it is levelled. units:
    of a matrix of heights, "mm". spacing: of the points of a matrix, or of a spectrum. outliers: slope of a step that
    is a spike, 3 if left out; 0 keeps all. longest: wave of a file that stays. shortest: wave that stays, or that a
    spectrum has. size: of a patch made of a spectrum, not a file. hurst: exponent of the spectrum. roll_off:
    wave beyond which the spectrum is flat; left out, size. rms_height: of the patch. rms_slope: of the patch, in
    place of rms_height. seed: of the phases. See `treadload.pavement.texture.self_affine`.

    >>> wheel = {"tire": {"profile": "315/80R22.5"}, "rolling": {"normal_load": "32.5 kN", "friction": 0.7}}
    >>> case = tl.Case.from_dict(wheel | {"pavement": {"structure": "6 BBSG3 / 15 GB3 / PF3", "temperature": 15}})
    >>> patch = {"size": "16 mm", "spacing": "0.5 mm", "hurst": 0.8, "shortest": "2 mm", "rms_height": "0.2 mm"}
    >>> patch["rubber"] = {"kind": "elastic", "modulus": "6 MPa", "poisson": 0.5}
    >>> tl.Case.from_dict(case.as_tables() | {"texture": patch}).steps[-1].name
    'texture'
    """

    shapes_contact: ClassVar = True

    resolved: bool = False
    enveloping: Length | None = None
    rubber: Annotated[Any, RUBBER] = None
    thickness: Length | None = None
    wave: Length | None = None
    file: Path | None = None
    units: str | None = None
    spacing: Length | None = None
    outliers: Number = 3.0
    shortest: Length | None = None
    longest: Length | None = None
    size: Length | None = None
    hurst: Number | None = None
    roll_off: Length | None = None
    rms_height: Length | None = None
    rms_slope: Number | None = None
    seed: int = 0

    @model_validator(mode="after")
    def _one_source(self) -> TextureStep:
        keys = [name for name in _SPECTRUM if name in self.model_fields_set]
        if self.file is not None and keys:
            raise ValueError(f"{keys[0]} is of a spectrum, and file of a measurement: give one of them")
        if self.outliers < 0:
            raise ValueError(f"outliers must be a slope > 0, or 0 to keep all, got {self.outliers:g}")
        self._one_way()
        for name in ("thickness", "wave", "spacing", "enveloping"):
            value = getattr(self, name)
            if value is not None:
                positive(name, value, "metres", "leave it out for the default")
        if self.file is None:
            stray = [name for name in ("units", "longest", "outliers") if name in self.model_fields_set]
            if stray:
                raise ValueError(f"{stray[0]} is of a file, and there is none; leave it out")
            missing = [name for name in ("size", "spacing", "hurst", "shortest") if getattr(self, name) is None]
            if missing:
                raise ValueError(f"'{missing[0]}' is missing: give a file, or size, spacing, hurst and shortest")
            self._spectrum()
        return self

    def _one_way(self) -> None:
        stray = [name for name in _OF_PATCH if self.resolved and name in self.model_fields_set]
        if stray:
            raise ValueError(
                f"{stray[0]} is of a patch that stands for the texture, and a resolved one meets the tire of a case: "
                "leave it out, or resolved"
            )
        if not self.resolved and self.rubber is None:
            raise ValueError("'rubber' is missing: that of the tread; or resolved = true, for the tire of the case")
        if not self.resolved and self.enveloping is not None:
            raise ValueError("enveloping is of a resolved texture: give resolved = true, or leave it out")

    def check(self, case: Description) -> None:
        """Refuse what does not fit the rest of the case."""
        if case.tire is None:
            raise ValueError("[texture] needs the contact of a tire, and this case has a recorded footprint")
        if self.resolved:
            if self.file is None and case.spacing is not None:
                check_step(self._spectrum(), case.spacing)
            return
        if isinstance(self.build_rubber(), Prony) and case.speed is None:
            raise ValueError("the rubber of [texture] is viscoelastic: give the speed in [rolling] or [response]")

    @property
    def is_quick(self) -> bool:
        """True where the texture lies under the tire of the contact, and nothing is solved besides."""
        return self.resolved

    def cites(self, case: Description) -> tuple[str, ...]:
        """Methods of the step."""
        return () if self.resolved else TEXTURE

    def solve(self, scene: Scene) -> TextureContact | None:
        """The tread's rubber on a patch of the texture; None where the texture lies under the whole tire."""
        contact, case = scene.result("contact"), scene.case
        if self.resolved:
            return None
        assert isinstance(contact, Contact)
        return solve_texture(
            self.build(case.folder), self.build_rubber(), contact, thickness=self.thickness, speed=case.speed,
            wave=self.wave, progress=scene.tell,
        )  # fmt: skip

    def plan(self, outline: Outline) -> None:
        """The texture, and how it is met."""
        how = "under the whole tire" if self.resolved else "a patch under the pressures of the contact"
        outline.add("texture", f"{self.build(outline.case.folder)}; {how}")

    def build_rubber(self) -> Elastic | Prony:
        """The rubber."""
        rubber: Elastic | Prony = RUBBER.build(self.rubber)
        return rubber

    def build(self, folder: Path | None) -> Texture:
        """The texture, read and treated, or made. folder: of the case, from which its file is found."""
        if self.file is None:
            return self._spectrum()
        path = self.file if folder is None else folder / self.file
        texture = textures.read_texture(path, spacing=self.spacing, units=self.units)
        if self.outliers:
            texture = textures.remove_outliers(texture, slope=self.outliers)
        texture = textures.level(textures.fill_dropouts(texture, most=0.5))
        if self.shortest is not None or self.longest is not None:
            texture = textures.band_pass(texture, shortest=self.shortest, longest=self.longest)
        return texture

    def _spectrum(self) -> Texture:
        assert self.size is not None
        assert self.spacing is not None
        assert self.hurst is not None
        assert self.shortest is not None
        return textures.self_affine(
            self.size, self.spacing, hurst=self.hurst, shortest=self.shortest, roll_off=self.roll_off,
            rms_height=self.rms_height, rms_slope=self.rms_slope, seed=self.seed,
        )  # fmt: skip


class EnvelopingStep(Step, name="enveloping"):
    """The contact that loads the layers, with its pressure on peaks spread; asked for by `[texture]`.

    >>> wheel = {"tire": {"profile": "315/80R22.5"}, "rolling": {"normal_load": "32.5 kN", "friction": 0.7}}
    >>> case = tl.Case.from_dict(wheel | {"pavement": {"structure": "6 BBSG3 / 15 GB3 / PF3", "temperature": 15}})
    >>> patch = {"size": "16 mm", "spacing": "0.5 mm", "hurst": 0.8, "shortest": "2 mm", "rms_height": "0.2 mm"}
    >>> resolved = tl.Case.from_dict(case.as_tables() | {"texture": patch | {"resolved": True, "enveloping": "5 mm"}})
    >>> [step.name for step in resolved.steps]
    ['contact', 'response', 'slices', 'bowl', 'texture', 'enveloping']
    """

    makes: ClassVar = ("enveloped",)
    has_table: ClassVar = False

    @classmethod
    def wanted(cls, case: Description) -> EnvelopingStep | None:
        """The step where `[texture]` gives a length to spread over."""
        return cls() if case.texture is not None and case.texture.enveloping is not None else None

    @property
    def is_quick(self) -> bool:
        """True: it is known with the contact."""
        return True

    def solve(self, scene: Scene) -> Enveloped | None:
        """The spread pressure."""
        return scene.loaded.enveloped
