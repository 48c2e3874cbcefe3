"""Control of a robot by the library that the environment variable KENAF_LIBRARY names: "sim" (default) or "real".

    from kenaf import hrt

    with hrt.Session():
        for side in range(4):
            hrt.go_forward(100)     # millimetres
            hrt.turning(90)         # degrees

runs in simulation (start `kenaf-relayd --embedded` before), and with KENAF_LIBRARY=real on the robot, as a C program does
when it is linked with the other library. A program that must not depend on the environment imports kenaf.hrt_sim or
kenaf.hrt_real, which are this module for one library each; `help(kenaf.hrt_sim)` has their documentation.
"""

import importlib
import os
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from kenaf.hrt_sim import *
else:
    _name = os.environ.get("KENAF_LIBRARY", "sim")
    if _name not in ("sim", "real"):
        raise ImportError(f'KENAF_LIBRARY is "{_name}"; it must be "sim" or "real"')
    _library = importlib.import_module(f"kenaf.hrt_{_name}")
    __all__ = [name for name in dir(_library) if not name.startswith("_")]
    globals().update({name: getattr(_library, name) for name in __all__})
