"""The page behind nginx with TLS and passwords, by the two blocks of docs/howto/behind_a_proxy.md."""

import base64
import hashlib
import os
import re
import shutil
import socket
import subprocess
import time
from pathlib import Path

import pytest

from page_visits import PATIENCE, browser, serving

pytestmark = pytest.mark.browser

HOWTO = Path(__file__).parents[2] / "docs" / "howto" / "behind_a_proxy.md"
SECRET = "0123456789abcdef" * 4
NGINX = shutil.which("nginx") or "/usr/sbin/nginx"


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def configuration(folder, port, inner):
    """What the how-to says, in a server with TLS; for this machine without being root."""
    location, upgrade = re.findall("```nginx\n(.*?)```", HOWTO.read_text(encoding="utf-8"), re.DOTALL)
    location = location.replace("127.0.0.1:8137", f"127.0.0.1:{inner}").replace("the text of proxy.secret", SECRET)
    location = re.sub(r"auth_basic_user_file \S+;", f"auth_basic_user_file {folder}/passwords;", location)
    kinds = ("client_body", "proxy", "fastcgi", "uwsgi", "scgi")
    temporary = "\n".join(f"{kind}_temp_path {folder}/{kind};" for kind in kinds)
    # Its workers read the passwords in this private folder.
    user = "user root;" if os.geteuid() == 0 else ""
    return (
        f"{user} daemon off; pid {folder}/nginx.pid; error_log {folder}/error.log;\nevents {{}}\n"
        f"http {{ access_log off; {temporary}\n{upgrade}\n"
        f"server {{ listen 127.0.0.1:{port} ssl; ssl_certificate {folder}/cert.pem;\n"
        f"ssl_certificate_key {folder}/key.pem;\n{location} }} }}\n"
    )


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Where the proxy's files lie, with a certificate and its key."""
    folder = tmp_path_factory.mktemp("proxy")
    certificate = ("-x509", "-newkey", "rsa:2048", "-nodes", "-days", "2", "-subj", "/CN=127.0.0.1")
    subprocess.run(
        ["openssl", "req", *certificate, "-keyout", folder / "key.pem", "-out", folder / "cert.pem"],
        check=True, capture_output=True,
    )  # fmt: skip
    return folder


@pytest.fixture(scope="module")
def chromium(folder):
    """A browser that trusts the certificate.

    One that ignores the error starts each request again, and gives some up with ERR_TOO_MANY_RETRIES when many begin
    at once.
    """
    key = subprocess.run(
        ["openssl", "pkey", "-in", folder / "key.pem", "-pubout", "-outform", "der"], check=True, capture_output=True
    ).stdout
    trusted = base64.b64encode(hashlib.sha256(key).digest()).decode()
    with browser(f"--ignore-certificate-errors-spki-list={trusted}") as trusting:
        yield trusting


@pytest.fixture(scope="module")
def address(folder):
    """The page's address behind nginx."""
    if not Path(NGINX).exists():
        pytest.skip("no nginx here; .ci/run installs it")
    port, inner = free_port(), free_port()
    hashed = [
        subprocess.run(["openssl", "passwd", "-apr1", f"{name}s"], check=True, capture_output=True, text=True).stdout
        for name in ("anna", "bert")
    ]
    (folder / "passwords").write_text(f"anna:{hashed[0]}bert:{hashed[1]}")
    (folder / "proxy.secret").write_text(SECRET)
    (folder / "proxy.secret").chmod(0o600)
    base = f"https://127.0.0.1:{port}/treadload/"
    (folder / "service.toml").write_text(
        f'address = "{base}"\nuser_header = "X-Remote-User"\nsecret_file = "proxy.secret"\n'
        'memory_limit_mb = 3000\ntime_limit = "10 min"\n'
    )
    (folder / "nginx.conf").write_text(configuration(folder, port, inner))
    proxy = subprocess.Popen([NGINX, "-c", folder / "nginx.conf", "-e", folder / "error.log"])
    try:
        options = ("--service", str(folder / "service.toml"), "--port", str(inner))
        with serving(folder, *options, printed=base) as server:
            assert server.printed == base
            yield base
    finally:
        proxy.terminate()
        proxy.wait(timeout=30)


def visited(chromium, address, user):
    context = chromium.new_context(
        ignore_https_errors=True, http_credentials={"username": user, "password": f"{user}s"}
    )
    page = context.new_page()
    page.set_default_timeout(PATIENCE)
    errors = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.on("console", lambda line: errors.append(line.text) if line.type == "error" else None)
    page.goto(address)
    return context, page, errors


def test_two_users_solve_behind_nginx(chromium, address):
    context, page, errors = visited(chromium, address, "anna")
    page.wait_for_selector('#bench[data-ready="1"]')
    page.wait_for_selector('#bench[data-state="done"]')
    (cookie,) = context.cookies()
    assert (cookie["path"], cookie["secure"], cookie["sameSite"]) == ("/treadload", True, "Lax")
    # Links, exports and the other pages stay below the path.
    link = page.locator('a[data-take="csv"], a[data-take]').first.evaluate("link => link.href")
    assert link.startswith(f"{address}take/")
    taken = page.request.get(link)
    assert taken.status == 200, taken.text()
    page.get_by_role("link", name="Study", exact=False).first.click()
    page.wait_for_url(f"{address}study")
    page.wait_for_selector("#bench")
    assert not errors
    # Another user neither sees nor takes it.
    other, its_page, its_errors = visited(chromium, address, "bert")
    its_page.wait_for_selector('#bench[data-ready="1"]')
    assert its_page.request.get(link).status == 404
    assert not its_errors
    # Anna's cookie under Bert's name opens nothing.
    thief = chromium.new_context(ignore_https_errors=True, http_credentials={"username": "bert", "password": "berts"})
    thief.add_cookies([cookie])
    assert thief.request.get(link).status == 403
    for each in (context, other, thief):
        each.close()


def test_without_a_password_or_past_the_proxy_nobody_gets_in(chromium, address):
    context = chromium.new_context(ignore_https_errors=True)
    assert context.request.get(address).status == 401
    context.close()


def test_a_lost_connection_comes_back(chromium, address):
    context, page, _ = visited(chromium, address, "anna")
    page.wait_for_selector('#bench[data-ready="1"]')
    context.set_offline(True)
    time.sleep(3)
    context.set_offline(False)
    page.wait_for_selector('#bench[data-state="done"]')
    page.locator("#solve").click()
    page.wait_for_selector('#bench[data-ready="2"]')
    context.close()
