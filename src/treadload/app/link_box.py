"""The button that copies the case as a link, the address it copied, and what is wrong with a link that was opened."""

from __future__ import annotations

from collections.abc import Callable

from nicegui import ui

from treadload.app.case_link import form_of_link, link_of
from treadload.app.elements import call_script, plain, with_attributes
from treadload.app.form import Form
from treadload.app.session import Session
from treadload.errors import InputError


class LinkBox:
    """Links of one page. form: gives the form of now. take: called with a form that a link holds."""

    def __init__(self, session: Session, form: Callable[[], Form], take: Callable[[Form], object]) -> None:
        self._session, self._form, self._take = session, form, take
        self._client = ui.context.client
        self._problem = ui.element("div").props('role="alert" id="link-problem"')

    def button(self) -> None:
        """Put the button on the page that is being built."""
        plain("copy link", self._copy, label="copy a link that restores this case").props('id="copy-link"')
        self._address = ui.element("input").classes("address").props('readonly id="link"')
        with_attributes(self._address, aria_label="link of this case")
        self._address.set_visibility(False)

    def _copy(self) -> None:
        self._problem.clear()
        try:
            link = link_of(self._form(), frozenset(self._session.files.values()))
        except InputError as error:
            self._show(str(error))
            return
        self._address.set_visibility(True)
        with self._client:
            call_script("treadloadLinkTo", link)

    def restore(self, link: str) -> None:
        """Take the case of a link in place of the form; one that cannot be read leaves the form as it is."""
        with self._client:
            self._problem.clear()
            try:
                form = form_of_link(link, self._form().command)
            except InputError as error:
                self._show(str(error))
                return
            self._take(form)

    def _show(self, text: str) -> None:
        with self._problem:
            ui.label(text).classes("problem")
