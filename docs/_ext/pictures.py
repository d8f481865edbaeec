"""The pictures that an example writes beside itself become the pictures of its page."""

from pathlib import Path
from shutil import move


def moved_pictures(block, block_vars, gallery_conf):
    """An image scraper: moves what a block has written from the examples into the gallery."""
    folder = Path(block_vars["src_file"]).parent
    title = Path(block_vars["src_file"]).stem.replace("_", " ")
    return "".join(
        _shown(move(written, place), title, gallery_conf["src_dir"])
        for written, place in zip(sorted(folder.glob("*.png")), block_vars["image_path_iterator"], strict=False)
    )


def _shown(place, title, source):
    path = Path(place).relative_to(source).as_posix()
    return f"\n.. image:: /{path}\n   :alt: {title}\n   :class: sphx-glr-single-img\n"
