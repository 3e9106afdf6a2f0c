"""The form on the left of the page."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from nicegui import events, ui

from treadload.app import fields as keys
from treadload.app.fields import Field
from treadload.app.form import Checked, Form, profile_of
from treadload.app.guard import MOST_UPLOADED
from treadload.app.session import FOOTPRINTS, MAPS, MESHES, Session
from treadload.errors import InputError

_TOO_LARGE = f"this file is not of the kind that goes here, or larger than {MOST_UPLOADED // 2**20} MB"


def plain(text: str, do: Callable[..., Any], *, main: bool = False, label: str = "") -> Any:
    """A button. label: for who does not see it, where the text alone does not say."""
    button = ui.element("button").classes("plain main" if main else "plain").props('type="button"')
    if label:
        button.props(f'aria-label="{label}"')
    with button:
        ui.html(text, sanitize=False)
    return button.on("click", lambda: do())


def choosing(options: dict[str, str], value: str, label: str, do: Callable[[str], Any]) -> Any:
    """One of a few."""
    select = ui.select(options, value=value, label=label, on_change=lambda event: do(event.value))
    return select.props("dense outlined options-dense").classes("wide")


class Left:
    """The fields, and what is said of them. changed: called with a form that the reader takes."""

    def __init__(self, session: Session, changed: Callable[[Form], Any], opened: Callable[[str, str], Any]) -> None:
        self._session, self._changed, self._opened = session, changed, opened
        self._shown: dict[str, tuple[Field, Any]] = {}
        self._checked = Checked(None, {})
        self._problems: Any = None
        self._section: Any = None

    @property
    def form(self) -> Form:
        """As it stands."""
        return self._session.form

    def build(self) -> None:
        """Put the fields on the page."""
        self._problems = ui.element("div").props('role="alert" id="problems"')
        self._all()

    @ui.refreshable_method
    def _all(self) -> None:
        self._shown.clear()
        self._tire()
        self._rolling()
        self._road()
        self._grid()
        self._own_file()
        self.tell()

    def _again(self, form: Form) -> None:
        """The form has other fields than before."""
        self._session.form = form
        self._all.refresh()
        self._solve()

    def _solve(self) -> None:
        if self._checked.case is not None:
            self._changed(self.form)

    def take(self, form: Form) -> None:
        """Show another form, of a run or a file."""
        self._session.form = form
        self._all.refresh()

    def tell(self) -> None:
        """Check the form, and say at each field whose its value is and what is wrong with it."""
        self._checked = self.form.check(self._session.folder)
        for path, (field, element) in self._shown.items():
            wrong = self._checked.at(path, set(self._shown))
            yours = self.form.is_yours(path)
            otherwise = keys.default_of(field, self._checked.case)
            given = self.form.value(path) is not None
            hint = "yours" if yours else "default" if given or not otherwise else f"default: {otherwise}"
            element.props(f'hint="{hint}"').props(remove="error error-message")
            element.classes(add="is-yours" if yours else "", remove="" if yours else "is-yours")
            if wrong:
                element.props["error"], element.props["error-message"] = True, wrong
                element.update()
        self._problems.clear()
        with self._problems:
            for text in self._checked.elsewhere(set(self._shown)):
                ui.label(text).classes("problem")
        self._draw_section()

    def say(self, text: str) -> None:
        """Say what is wrong with the whole."""
        self._problems.clear()
        with self._problems:
            ui.label(text).classes("problem")

    def _field(self, field: Field, *, wide: bool = False) -> None:
        value = field.shown(self.form.value(field.path))
        element: Any
        if field.kind == "choice":
            options = dict(field.choices or {})
            if value and value not in options:
                options[value] = value
            if not value and "" not in options:
                value = field.shown(keys.default_of(field, None)) or next(iter(options))
            element = ui.select(options, value=value, label=field.label)
            element.on_value_change(lambda event: self._typed(field, str(event.value or "")))
            element.props("options-dense")
        else:
            element = ui.input(field.label, value=value)
            suffix = field.unit if field.unit else ""
            element.props(f'suffix="{suffix}" stack-label autocomplete="off"')
            element.on("blur", lambda: self._typed(field, str(element.value or "")))
            element.on("keydown.enter", lambda: self._typed(field, str(element.value or "")))
        element.props(f'dense outlined data-path="{field.path}"').classes("field wide" if wide else "field")
        if field.words:
            element.tooltip(field.words)
        self._shown[field.path] = (field, element)

    def _typed(self, field: Field, text: str) -> None:
        if text.strip() == field.shown(self.form.value(field.path)):
            return
        before = self.form.table
        self._session.form = self.form.with_text(field, text)
        self.tell()
        if self.form.table != before:
            self._solve()

    # The groups of fields.

    def _tire(self) -> None:
        form = self.form
        ui.element("h2").style("margin-top:4px").props('innerHTML="Tire"')
        with ui.element("div").classes("fields"):
            choosing(dict(keys.SURFACES), form.surface, "Surface", self._surface)
            if form.surface in ("scan", "height_map"):
                file = form.value("tire.scan") or form.value("tire.height_map")
                ui.label(f"file: {self._session.known_as(str(file))}").classes("wide note")
            for field in keys.tire_fields(form.surface, has_belt=form.value("tire.belt") is not None):
                self._field(field, wide=field.kind == "choice")
            self._field(keys.BELT)
        if form.surface == "profile":
            self._section = ui.plotly({"data": [], "layout": {}}).style("height:120px").classes("section-of-tread")
            grooves = form.value("tire.profile.grooves") or []
            for number, row in enumerate(keys.groove_fields(len(grooves))):
                with ui.element("div").classes("layer"):
                    with ui.element("div").classes("head"):
                        ui.label(f"groove {number + 1}")
                        plain("remove", lambda n=number: self._grooves([g for k, g in enumerate(grooves) if k != n]))
                    with ui.element("div").classes("fields").style("grid-template-columns:1fr 1fr 1fr"):
                        for field in row:
                            self._field(field)
            plain(
                "add a groove",
                lambda: self._grooves([*grooves, {"centre": "0 mm", "width": "10 mm", "depth": "12 mm"}]),
            )
        else:
            self._section = None
        with ui.element("div").classes("line").style("margin-top:6px"):
            self.upload("mesh …", MESHES, lambda kept: self._again(self.form.with_surface("scan", kept)), "mesh")
            self.upload(
                "height map …", MAPS, lambda kept: self._again(self.form.with_surface("height_map", kept)), "map"
            )
            self.upload("footprint …", FOOTPRINTS, self._footprint, "footprint")

    def _grooves(self, grooves: list[Any]) -> None:
        self._again(self.form.with_values({"tire.profile.grooves": grooves}))

    def _surface(self, surface: str) -> None:
        if surface in ("scan", "height_map"):
            self.say("choose the file below: “mesh …” or “height map …”")
            self._all.refresh()
            return
        self._again(self.form.with_surface(surface))

    def _draw_section(self) -> None:
        """The cross-section of a profile, live."""
        profile = profile_of(self.form)
        if self._section is None or profile is None:
            return
        half = 0.5 * profile.width
        places = [half * (number / 120 - 1) for number in range(241)]
        drop = profile.drop(places)  # type: ignore[arg-type]
        axis = {"showgrid": False, "zeroline": False, "ticks": "outside", "tickfont": {"size": 10}}
        self._section.figure = {
            "data": [{"type": "scatter", "mode": "lines", "x": [1e3 * y for y in places], "hoverinfo": "skip",
                      "y": [-1e3 * float(one) for one in drop], "line": {"color": "#8a94a0", "width": 2}}],
            "layout": {"height": 120, "margin": {"l": 34, "r": 6, "t": 6, "b": 30},
                       "font": {"size": 10, "color": "#8a94a0"},
                       "paper_bgcolor": "rgba(0,0,0,0)", "plot_bgcolor": "rgba(0,0,0,0)",
                       "xaxis": {**axis, "title": {"text": "y (mm)", "standoff": 2}},
                       "yaxis": {**axis, "title": {"text": "mm"}}},
            "config": {"displayModeBar": False},
        }  # fmt: skip
        self._section.update()

    def _rolling(self) -> None:
        form = self.form
        ui.element("h2").props('innerHTML="Wheel"')
        with ui.element("div").classes("fields"):
            self._field(keys.LOAD)
            self._field(keys.FRICTION)
            self._field(keys.SPEED)
            choosing(dict(keys.STATES), form.state, "It",
                     lambda state: self._again(self.form.with_state(state, by_force=self.form.by_force))
                     ).classes(remove="wide")  # fmt: skip
            if form.state != "free":
                choosing({"force": "by force", "creepage": "by creepage"}, "force" if form.by_force else "creepage",
                         "Prescribed", lambda by: self._again(form.with_state(form.state, by_force=by == "force"))
                         ).classes(remove="wide")  # fmt: skip
                for field in keys.rolling_fields(form.state, by_force=form.by_force):
                    self._field(field)

    def _road(self) -> None:
        form = self.form
        ui.element("h2").props('innerHTML="Road"')
        with ui.element("div").classes("fields"):
            choosing(dict(keys.ROADS), form.road, "Road", lambda kind: self._again(self.form.with_road(kind)))
            if form.road == "structure":
                self._field(keys.STRUCTURE, wide=True)
        layers = form.layers
        mixes = any(isinstance(layer, dict) and "mix" in layer for layer in layers)
        if form.road == "half_space":
            with ui.element("div").classes("fields"):
                for field in keys.layer_fields(0, mix=mixes, last=True):
                    self._field(field)
        elif form.road == "layers":
            for number, layer in enumerate(layers):
                self._layer(number, layer, len(layers))
            plain("add a layer", lambda: self._add_layer())
        if mixes or form.road == "structure" or form.value("pavement.temperature") is not None:
            with ui.element("div").classes("fields").style("margin-top:6px"):
                self._field(keys.TEMPERATURE)
                self._field(keys.FREQUENCY)

    def _layer(self, number: int, layer: Any, count: int) -> None:
        last = number == count - 1
        is_mix = isinstance(layer, dict) and "mix" in layer
        with ui.element("div").classes("layer"):
            with ui.element("div").classes("head"):
                name = layer.get("name") or layer.get("mix") or "" if isinstance(layer, dict) else ""
                ui.label(f"{number + 1}  {name}{', endlessly deep' if last else ''}")
                with ui.element("div").classes("line"):
                    plain("as modulus" if is_mix else "as mix", lambda: self._kind_of_layer(number, not is_mix))
                    if count > 2 and not last:
                        kept = [one for k, one in enumerate(self.form.layers) if k != number]
                        plain(
                            "remove",
                            lambda: self._again(self.form.with_layers(kept)),
                            label=f"remove layer {number + 1}",
                        )
            with ui.element("div").classes("fields"):
                for field in keys.layer_fields(number, mix=is_mix, last=last):
                    self._field(field)

    def _kind_of_layer(self, number: int, mix: bool) -> None:
        layers = [dict(one) for one in self.form.layers]
        layer = {key: value for key, value in layers[number].items() if key in ("thickness", "bond")}
        own = (
            {"mix": "EB-BBSG3"} if mix else {"material": {"kind": "elastic", "modulus": "5400 MPa", "poisson": 0.35}}
        )
        layers[number] = {**layer, **own}
        form = self.form.with_layers(layers)
        waits = any("mix" in one for one in layers)
        self._again(form.with_values({"pavement.temperature": 15 if waits else None}))

    def _add_layer(self) -> None:
        layers = list(self.form.layers)
        layer = {
            "name": "layer",
            "thickness": "100 mm",
            "material": {"kind": "elastic", "modulus": "9000 MPa", "poisson": 0.35},
        }
        self._again(self.form.with_layers([*layers[:-1], layer, layers[-1]]))

    def _grid(self) -> None:
        ui.element("h2").props('innerHTML="Grid and verdict"')
        with ui.element("div").classes("fields"):
            self._field(keys.SPACING)
            self._field(keys.TOLERANCE)
            self._field(keys.DEPTHS, wide=True)
            if self.form.value("damage") is not None:
                self._field(keys.EPSILON)
                self._field(keys.SLOPE)
                self._field(keys.STRAIN, wide=True)
        if self.form.value("damage") is None:
            plain(
                "add a verdict", lambda: self._again(self.form.with_values({"damage": Form.first().table["damage"]}))
            )
        else:
            plain("no verdict", lambda: self._again(self.form.with_values({"damage": None})))

    def _own_file(self) -> None:
        ui.element("h2").props('innerHTML="Your case"')
        with ui.element("div").classes("line"):
            self.upload("open a TOML …", (".toml",), None, "toml")
            self.upload("open a result …", (".nc",), None, "result")
            plain("begin anew", lambda: self._again(Form.first()))

    # Files.

    def upload(self, text: str, suffixes: tuple[str, ...], kept: Callable[[str], Any] | None, name: str) -> None:
        """A button that asks for a file. kept: called with the name under which it is kept."""
        with ui.element("div").classes("upload"):
            chooser = ui.upload(
                auto_upload=True, max_file_size=MOST_UPLOADED, on_rejected=lambda: self.say(_TOO_LARGE),
                on_upload=lambda event: self._uploaded(event, suffixes, kept),
            )  # fmt: skip
            chooser.props(f'accept="{",".join(suffixes)}" aria-hidden="true" tabindex="-1"').classes(f"upload-{name}")
            plain(text, lambda: chooser.run_method("pickFiles"))

    async def _uploaded(
        self, event: events.UploadEventArguments, suffixes: tuple[str, ...], kept: Callable[[str], Any] | None
    ) -> None:
        try:
            content = await event.file.read()
            if len(content) > MOST_UPLOADED:
                raise InputError(_TOO_LARGE)
            if suffixes == (".toml",):
                try:
                    text = content.decode("utf-8")
                except UnicodeDecodeError as error:
                    raise InputError(f"{event.file.name[:120]} is not a text file in UTF-8") from error
                self._again(Form.from_text(text, event.file.name[:120], self._session.files))
                return
            name = self._session.keep(event.file.name, content, suffixes)
        except InputError as error:
            self.say(str(error))
            return
        made = self._opened("result", name) if kept is None else kept(name)
        if hasattr(made, "__await__"):
            await made

    def _footprint(self, kept: str) -> Any:
        return self._opened("footprint", kept)
