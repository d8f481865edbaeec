import copy

import pytest


@pytest.fixture(scope="session")
def pack(tmp_path_factory):
    """Question, record and folder of a small pack; nothing may change them."""
    pytest.importorskip("xarray", reason="the extra for studies is not installed")
    from .small_pack import small_pack

    return small_pack(tmp_path_factory.mktemp("pack"))


@pytest.fixture
def record(pack):
    return copy.deepcopy(pack[1])
