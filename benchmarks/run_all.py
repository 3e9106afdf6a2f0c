"""All benchmarks in one run, on one core: numbers that can be compared stand side by side."""

import os

# Before numpy is loaded: one thread, or the floors and the solves would not be comparable.
for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[variable] = "1"

import platform  # noqa: E402

import numpy  # noqa: E402
import scipy  # noqa: E402


def main() -> None:
    # The chain first, so that its cold figure is cold.
    import whole_chain  # noqa: I001
    import layered
    import life
    import moving
    import normal_contact
    import rolling_contact
    import belt
    import indentation
    import page
    import peers
    import scaling
    import scans
    import studies
    import year

    print(f"Python {platform.python_version()}, numpy {numpy.__version__}, scipy {scipy.__version__}, one thread\n")
    whole_chain.main()
    normal_contact.main()
    rolling_contact.main()
    belt.main()
    indentation.main()
    scaling.main(peers.main())
    scans.main()
    studies.main()
    layered.main()
    moving.main()
    life.main()
    year.main()
    page.main()


if __name__ == "__main__":
    main()
