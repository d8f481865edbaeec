"""The pictures that an example writes beside itself become the pictures of its page."""

from pathlib import Path
from shutil import move

from sphinx_gallery.scrapers import figure_rst


def moved_pictures(block, block_vars, gallery_conf):
    """An image scraper: moves what a block has written from the examples into the gallery."""
    folder = Path(block_vars["src_file"]).parent
    places = []
    for written, place in zip(sorted(folder.glob("*.png")), block_vars["image_path_iterator"], strict=False):
        move(written, place)
        places.append(place)
    return figure_rst(places, gallery_conf["src_dir"])
