"""Where an image was taken, in a map."""
from __future__ import annotations

import os
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from opencv_iib import _core
from opencv_iib._arrays import as_image

#: COLMAP's camera: ``model``, ``width``, ``height`` and ``params``; ``Camera.parse('MODEL,WIDTH,HEIGHT,PARAMS')`` makes one,
#: ``project`` gives the pixels of N x 3 float64 points in its axes (NaN for what it does not see), and ``undistorted`` of N x 2 pixels
#: those that a camera without distortion would have, of the 3 x 3 ``matrix``.
Camera = _core.Camera
#: What Localizer.localize finds: ``cam_from_world`` (4 x 4 float64, or None: then ``reason`` says why), ``covariance`` (6 x 6, of
#: the camera's centre in the map's unit and of a small turn about the world's axes in radians; or None), ``matches``,
#: ``inliers``, their ``pixels`` (N x 2, the centre of the first pixel is 0) and the ``points`` of the map seen there (N x 3).
Location = _core.Location

AnyCamera = Union[Camera, str, Any]


def as_camera(camera: AnyCamera) -> Camera:
    """A Camera, the text of one, or an object like pycolmap.Camera, as Camera.

    :raises opencv_iib.error: for an unknown model or wrong parameters.
    """
    if isinstance(camera, Camera):
        return camera
    if not isinstance(camera, str):
        params = (repr(float(value)) for value in camera.params)
        camera = ','.join((camera.model_name, str(camera.width), str(camera.height), *params))
    return Camera.parse(camera)


def as_pose(pose: ArrayLike) -> NDArray[np.float64]:
    """A 3 x 4 or 4 x 4 rigid motion as 4 x 4."""
    matrix = np.asarray(pose, np.float64)
    if matrix.shape not in ((3, 4), (4, 4)) or not np.isfinite(matrix).all():
        raise ValueError(f'a pose is 3 x 4 or 4 x 4 finite numbers, not {matrix.shape}')
    return np.concatenate([matrix[:3], [[0, 0, 0, 1]]])


class Localizer:
    """Finds images in a map. Threads may share one."""

    def __init__(self, map: Union[str, os.PathLike[str]], points: int = 1000, lines: bool = False) -> None:
        """Reads a map.

        :param map: its folder.
        :param points: keypoints that are looked for in an image; 0: as many as in the map's images, which takes twice the time
            and finds more in hard light.
        :param lines: refine poses by lines too; the map must have been made with them.
        :raises opencv_iib.error: for a folder without a map, or a damaged one; for lines of a map without them, or where OpenCV's module
            line_descriptor was missing in the build.
        """
        self._core = _core.Localizer(map, points, lines)

    @property
    def cameras(self) -> list[Camera]:
        """Of the map's images, each once."""
        return self._core.cameras()

    def localize(self, image: ArrayLike, camera: AnyCamera, prior: Optional[ArrayLike] = None) -> Location:
        """Where an image was taken. The GIL is released meanwhile.

        :param image: H x W or H x W x 3 (BGR) uint8, as its file stores it, not turned as EXIF may ask.
        :param camera: of the image's size: a Camera, ``'MODEL,WIDTH,HEIGHT,PARAMS'``, or an object like pycolmap.Camera.
        :param prior: camera from world, 4 x 4 or 3 x 4, such as the last image's: only the two images of the map nearest to it
            are compared, and only points within a tenth of the longer side from where the prior has them. If that gives no
            pose, the image is looked for everywhere.
        :raises opencv_iib.error: for an image of another size or type, or an invalid camera.
        """
        return self._core.localize(as_image(image), as_camera(camera), None if prior is None else as_pose(prior))
