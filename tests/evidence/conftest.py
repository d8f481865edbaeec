from shutil import rmtree

import pytest


@pytest.fixture(scope="session")
def pack():
    pytest.importorskip("xarray", reason="the extra for studies is not installed")
    from .small_pack import small_pack

    yield small_pack()
    rmtree(small_pack()[2])
