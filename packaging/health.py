"""Is a container well? `python health.py` ends with 0 where it is, else with 1 and a reason.

Where `treadload app` serves the page its `/health` is asked, at the address that the server writes into its private
folder; where the command line runs there is no server, and the program has to start.
"""

from __future__ import annotations

import http.client
import json
import subprocess
import sys
import tempfile
from pathlib import Path

SECONDS = 10.0
# Addresses that a server listens on and nobody can call.
ANY = {"0.0.0.0": "127.0.0.1", "::": "::1"}


def answers(host: str, port: int) -> bool:
    """True where a page answers that it is served."""
    connection = http.client.HTTPConnection(ANY.get(host, host), port, timeout=SECONDS)
    try:
        connection.request("GET", "/health")
        return connection.getresponse().status == 200
    except (OSError, http.client.HTTPException):
        return False
    finally:
        connection.close()


def main() -> int:
    """0 where the page answers, or where there is none and the program starts."""
    servers = []
    for file in Path(tempfile.gettempdir()).glob("treadload-app-*/server.json"):
        about = json.loads(file.read_text(encoding="utf-8"))
        servers.append((str(about["host"]), int(about["port"])))
    if not servers:
        return subprocess.run(["treadload", "--version"], check=False, timeout=SECONDS).returncode
    silent = [f"{host}, port {port}" for host, port in servers if not answers(host, port)]
    if silent:
        print(f"the page does not answer on {'; '.join(silent)}", file=sys.stderr)
    return int(bool(silent))


if __name__ == "__main__":
    sys.exit(main())
