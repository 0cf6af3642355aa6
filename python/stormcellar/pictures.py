"""Pictures of volumes and grids."""

from __future__ import annotations

import ctypes
import typing

import numpy as np
import numpy.typing as npt

from . import _library
from ._library import Handle, call, sized
from .grids import Grid
from .volume import Volume


if typing.TYPE_CHECKING:
    from .volume import Source


class Picture(bytes):
    """The bytes of a PNG file, which Jupyter shows. The metadata in the file say how it was made.

    >>> stormcellar.draw(FILE, "ppi").startswith(b"\\x89PNG")
    True
    """

    def _repr_png_(self) -> bytes:
        return bytes(self)

    def __repr__(self) -> str:
        return f"<Picture, {len(self)} bytes of PNG>"


def draw(source: Volume | Grid | Source, product: str = "volume", moment: str | None = None, *, width: int = 0,
         height: int = 0, pixels: bool = False, threads: int = 1,
         **settings: typing.Any) -> Picture | npt.NDArray[np.uint8]:
    """Draws a Volume, a file or a Grid as `stormcellar frame` does with the same options, and returns a Picture, a PNG
    with the same bytes. With `pixels=True`, returns an array of uint8 instead, shape (height, width, 4): red, green,
    blue and alpha (sRGB), from the top.

    `product`: volume (in three dimensions), ppi (one sweep; not of a Grid), composite, cappi, section, echotop and the
    others of `stormcellar frame --help`, but no product over several volumes. `moment`: by default the grid's or the
    product's, or else REF. `settings` are further options of `frame`, such as theme="light", elevation=1.5,
    height_km=3, units="si", section=(35.2, -98.1, 35.4, -97.3) or no_labels=True. Raises Error for an option that the
    product does not have. Errors of drawn values: docs/rendering.md.

    >>> stormcellar.draw(FILE, "composite", width=640, height=480, pixels=True, theme="light").shape
    (480, 640, 4)
    """
    texts = [f"{name.replace('_', '-')}={_text(value)}".encode() for name, value in settings.items()]
    options = sized(_library.DrawOptions, product=product.encode(), moment=moment.encode() if moment else None,
                    width=width, height=height, settings=(ctypes.c_char_p * len(texts))(*texts),
                    setting_count=len(texts), format=0 if pixels else 1, threads=threads)
    if not isinstance(source, (Volume, Grid)):
        source = Volume(source, threads=threads)
    name = "grid_draw" if isinstance(source, Grid) else "volume_draw"
    pointer = ctypes.c_void_p()
    call(name, source._handle.pointer, ctypes.byref(options), ctypes.byref(pointer))
    handle = Handle("picture", pointer)
    facts = sized(_library.PictureFacts)
    call("picture_describe", pointer, ctypes.byref(facts))
    first = ctypes.c_void_p()
    call("picture_bytes", pointer, ctypes.byref(first))
    memory = (ctypes.c_uint8 * facts.bytes).from_address(first.value)
    if not pixels:
        return Picture(memory)
    memory._handle = handle
    picture = np.frombuffer(memory, "u1").reshape(facts.height, facts.width, 4)
    picture.flags.writeable = False
    return picture


def _text(value):
    if isinstance(value, bool):
        return str(value).lower()
    return value if isinstance(value, str) or not hasattr(value, "__iter__") else ",".join(str(one) for one in value)
