"""Pictures for light and for dark pages: each figure twice, transparent, and the page shows the one that suits it."""

from os import getpid
from pathlib import Path

import numpy as np
from docutils import nodes
from matplotlib.image import imread, imsave
from sphinx.transforms import SphinxTransform

INK = 0.3  # what is darker than this is text or a line, and light on a dark page
SCREENS = "app_"  # pictures of a window keep what they show


def setup(app):
    app.add_transform(BothPalettes)
    return {"parallel_read_safe": True, "parallel_write_safe": True}


class BothPalettes(SphinxTransform):
    """Every PNG of a page by its two versions."""

    default_priority = 200  # before the files of the images are collected

    def apply(self, **kwargs):
        source, folder = Path(self.env.srcdir), Path(self.env.doc2path(self.env.docname)).parent
        for image in list(self.document.findall(nodes.image)):
            picture = self._file(image["uri"], source, folder)
            if picture.suffix != ".png" or picture.name.startswith(SCREENS) or not picture.is_file():
                continue
            versions = []
            for name, coloured in (("light", on_light), ("dark", on_dark)):
                path = source / "_generated" / "palettes" / f"{picture.stem}.{name}.png"
                write(picture, path, coloured)
                version = image.deepcopy()
                version["uri"] = f"/{path.relative_to(source).as_posix()}"
                version["classes"] = [*image["classes"], f"only-{name}"]
                versions.append(version)
            image.replace_self(versions)

    @staticmethod
    def _file(uri: str, source: Path, folder: Path) -> Path:
        return source / uri[1:] if uri.startswith("/") else folder / uri


def write(picture: Path, path: Path, coloured) -> None:
    """One version of a picture, anew where the picture is newer."""
    if path.is_file() and path.stat().st_mtime >= picture.stat().st_mtime:
        return
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_suffix(f".{getpid()}.png")  # pages with the same picture are read at the same time
    imsave(part, coloured(imread(picture)))
    part.replace(path)


def on_light(pixels: np.ndarray) -> np.ndarray:
    """(height, width, 4): the pixels over white with as little of each as shows them: white is all transparent."""
    colours = over_white(pixels)
    cover = 1.0 - colours.min(axis=-1, keepdims=True)
    ink = np.divide(colours - (1.0 - cover), cover, out=np.zeros_like(colours), where=cover > 0.0)
    return np.concatenate([np.clip(ink, 0.0, 1.0), cover], axis=-1)


def on_dark(pixels: np.ndarray) -> np.ndarray:
    """The same with ink in white; colours stay what they are."""
    light = on_light(pixels)
    ink, cover = light[..., :3], light[..., 3:]
    darkness = 1.0 - ink.max(axis=-1, keepdims=True)
    turned = np.clip((darkness - (1.0 - INK)) / INK, 0.0, 1.0)
    return np.concatenate([ink + turned * darkness, cover], axis=-1)


def over_white(pixels: np.ndarray) -> np.ndarray:
    if pixels.ndim == 2:
        pixels = np.repeat(pixels[..., None], 3, axis=-1)
    if pixels.shape[-1] == 3:
        return pixels
    return pixels[..., :3] * pixels[..., 3:] + 1.0 - pixels[..., 3:]
