import copy
from shutil import rmtree

import pytest


@pytest.fixture(scope="session")
def pack():
    """Question, record and folder of a small pack; nothing may change them."""
    pytest.importorskip("xarray", reason="the extra for studies is not installed")
    from .small_pack import small_pack

    yield small_pack()
    rmtree(small_pack()[2])


@pytest.fixture
def record(pack):
    """Copy of the record of the small pack."""
    return copy.deepcopy(pack[1])
