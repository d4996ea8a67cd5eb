"""The name `microtexture` in a checkout: the modules of `app.synthesis` themselves, as their wheel names them.

Each module stays one: `microtexture.gaussian.rpn is app.synthesis.gaussian.rpn`. Neither wheel holds this file.
"""

import pkgutil
import sys
from importlib import import_module

import app.synthesis

for _found in pkgutil.walk_packages(app.synthesis.__path__, "app.synthesis."):
    sys.modules[_found.name.replace("app.synthesis", "microtexture", 1)] = import_module(_found.name)
sys.modules["microtexture"] = app.synthesis
