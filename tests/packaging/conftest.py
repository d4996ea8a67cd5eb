"""Built wheels and the environments that they are installed into, one of each for all tests."""

from pathlib import Path

import pytest

from app.settings import ROOT
from tests.packaging.environments import Environment, build, dependencies, environment


@pytest.fixture(scope="session")
def service_wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return build(ROOT, "wheel", tmp_path_factory.mktemp("wheel"))


@pytest.fixture(scope="session")
def service(service_wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Environment:
    """The service's wheel, installed beside the locked dependencies."""
    return environment(tmp_path_factory.mktemp("service"), service_wheel, dependencies())
