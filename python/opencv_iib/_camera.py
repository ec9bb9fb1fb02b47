"""A camera as COLMAP describes it."""
from __future__ import annotations

from typing import Any, Iterable, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from opencv_iib import _core
from opencv_iib._arguments import integer, number
from opencv_iib._arrays import as_array


class Camera(_core.Camera):
    """A camera as COLMAP describes it, with the attributes ``model``, ``width``, ``height`` and ``params``.

    ``Camera.parse('PINHOLE,640,480,500,500,320,240')`` makes one too. The centre of the first pixel is (0, 0), but (.5, .5) in `params`,
    as in COLMAP."""

    def __init__(self, model: str, width: int, height: int, params: Iterable[float]) -> None:
        """Creates a camera.
        :param model: COLMAP's name of the model, in any case.
        :param params: COLMAP's parameters, in its order.
        :raises opencv_iib.error: for an unknown model or wrong parameters."""
        values = [str(model).upper(), integer(width, 'width'), integer(height, 'height'), *(number(value, 'params') for value in params)]
        super().__init__(_core.Camera.parse(','.join(map(str, values))))

    @classmethod
    def parse(cls, text: str) -> Camera:
        """Makes a camera of ``'MODEL,WIDTH,HEIGHT,PARAMS'``. :raises opencv_iib.error: for an unknown model or wrong parameters."""
        if not isinstance(text, str):
            raise TypeError(f"camera: a text 'MODEL,WIDTH,HEIGHT,PARAMS' is needed, not {text!r}")
        model, comma, rest = text.partition(',')
        return cls._of(_core.Camera.parse(model.strip().upper() + comma + rest))

    @classmethod
    def _of(cls, core: _core.Camera) -> Camera:
        return cls(core.model, core.width, core.height, core.params)

    def project(self, points: ArrayLike) -> NDArray[np.float64]:
        """Pixels, N x 2, of points in the camera's axes (x right, y down, z ahead), N x 3; NaN for points that it does not see."""
        return super().project(as_rows_of(points, 3, 'points'))

    def undistorted(self, pixels: ArrayLike) -> NDArray[np.float64]:
        """Pixels, N x 2, as seen by a camera with the same `matrix` and no distortion, as findRelativePose needs them; NaN for pixels that show
        nothing."""
        return super().undistorted(as_rows_of(pixels, 2, 'pixels'))

    def resized(self, width: int, height: int) -> Camera:
        """The camera of resized images, whose corners stay in place, as by all of OpenCV's interpolations."""
        return Camera._of(super().resized(integer(width, 'width'), integer(height, 'height')))

    def upright(self, orientation: int) -> Camera:
        """The camera of upright images.
        :param orientation: EXIF's, of the stored images: 1, 3, 6 or 8.
        :raises opencv_iib.error: for another one: no camera sees a mirrored image."""
        return Camera._of(super().upright(integer(orientation, 'orientation')))

    def _values(self) -> tuple[str, int, int, tuple[float, ...]]:
        return self.model, self.width, self.height, tuple(self.params)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Camera) and self._values() == other._values()

    def __hash__(self) -> int:
        return hash(self._values())

    def __reduce__(self) -> Any:
        return Camera, self._values()

    def __str__(self) -> str:
        return ','.join([self.model, *(f'{value:.15g}' for value in (self.width, self.height, *self.params))])

    def __repr__(self) -> str:
        return f'Camera({self.model!r}, {self.width}, {self.height}, {self.params})'


AnyCamera = Union[_core.Camera, str, Any]


def as_camera(camera: AnyCamera) -> Camera:
    """A Camera, the text of one, or an object like pycolmap.Camera, as Camera. :raises opencv_iib.error: for an unknown model or wrong parameters."""
    if isinstance(camera, _core.Camera):
        return camera if isinstance(camera, Camera) else Camera._of(camera)
    if isinstance(camera, str) or not hasattr(camera, 'model_name'):
        return Camera.parse(camera)
    return Camera(camera.model_name, camera.width, camera.height, camera.params)


def as_rows_of(values: ArrayLike, columns: int, what: str) -> NDArray[np.float64]:
    """Rows of so many columns, float64. :raises ValueError: for another shape."""
    rows = as_array(values, what)
    if rows.size and rows.shape[1:] != (columns,):
        raise ValueError(f'{what}: an array of N x {columns} is needed, not of {" x ".join(map(str, rows.shape))}')
    return rows.reshape(-1, columns).astype(np.float64, copy=False)
