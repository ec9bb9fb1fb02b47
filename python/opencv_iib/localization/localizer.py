"""Finds where an image was taken, in a map."""
from __future__ import annotations

import os
from typing import Any, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from opencv_iib import _core
from opencv_iib._arguments import Path, integer
from opencv_iib._arrays import as_array, as_image, as_mask
from opencv_iib._camera import AnyCamera, Camera, as_camera, as_rows_of


class Location:
    """The result of :meth:`Localizer.localize`: `found`, and if not, the `reason`.

    ``cam_from_world`` is 4 x 4, the ``covariance`` 6 x 6: of the camera's centre (map's unit) and of a small rotation about the world's
    axes (radians). Both are None without a pose. `inliers` of the `matches` agree: ``pixels``, N x 2 (the centre of the first pixel
    is 0), show the ``points`` of the map, N x 3."""

    def __init__(self, cam_from_world: Optional[ArrayLike] = None, covariance: Optional[ArrayLike] = None, reason: str = '',
                 matches: int = 0, inliers: int = 0, pixels: ArrayLike = (), points: ArrayLike = ()) -> None:
        """A pose and its covariance, such as of another method for :func:`smooth_poses`; or neither."""
        if (cam_from_world is None) != (covariance is None):
            raise ValueError('a pose and its covariance come together, or none of them')
        self.found, self.reason = cam_from_world is not None, str(reason)
        self.cam_from_world: Any = None if cam_from_world is None else as_pose(cam_from_world)
        self.covariance: Any = None if covariance is None else as_rows_of(np.reshape(covariance, (6, 6)), 6, 'covariance')
        self.matches, self.inliers = integer(matches, 'matches'), integer(inliers, 'inliers')
        self.pixels, self.points = as_rows_of(pixels, 2, 'pixels'), as_rows_of(points, 3, 'points')

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Location) and all(map(np.array_equal, vars(self).values(), vars(other).values()))

    def __repr__(self) -> str:
        if self.cam_from_world is None:
            return f'Location(reason={self.reason!r})'
        place = -self.cam_from_world[:3, :3].T @ self.cam_from_world[:3, 3]
        return f'Location(centre {place.round(3).tolist()}, {self.inliers} of {self.matches} matches agree)'


def as_pose(pose: ArrayLike) -> NDArray[np.float64]:
    """A 3 x 4 or 4 x 4 rigid motion as 4 x 4."""
    matrix = as_array(pose, 'a pose').astype(np.float64, copy=False)
    if matrix.shape not in ((3, 4), (4, 4)) or not np.isfinite(matrix).all():
        raise ValueError(f'a pose is 3 x 4 or 4 x 4 finite numbers, not {matrix.shape}')
    return np.concatenate([matrix[:3], [[0, 0, 0, 1]]])


class Localizer:
    """Localizes images in a map. Threads may share one. A pickle holds the map's name, and reads it again."""

    def __init__(self, map: Path, points: int = 1000, lines: bool = False) -> None:
        """Reads a map.
        :param map: its folder.
        :param points: keypoints of an image; 0: as many as in the map's images, which takes twice the time and finds more under difficult illumination.
        :param lines: refine poses by lines too; the map must have been made with them.
        :raises opencv_iib.error: for a folder without a map, and a damaged map; with `lines`, for a map without lines, and a build without
            OpenCV's module line_descriptor."""
        self._arguments = os.path.abspath(map), integer(points, 'points'), bool(lines)
        self._core = _core.Localizer(*self._arguments)

    @property
    def cameras(self) -> list[Camera]:
        """The different cameras of the map's images."""
        return [Camera._of(camera) for camera in self._core.cameras()]

    def localize(self, image: ArrayLike, camera: AnyCamera, prior: Optional[ArrayLike] = None, orientation: int = 1,
                 mask: Optional[ArrayLike] = None) -> Location:
        """Finds the pose of an image. The GIL is released meanwhile.

        :param image: H x W or H x W x 3 (BGR) uint8, as stored in its file. The pose and pixels are those of these pixels.
        :param camera: of the image's size: a Camera, ``'MODEL,WIDTH,HEIGHT,PARAMS'``, or an object like pycolmap.Camera.
        :param prior: camera from world, 4 x 4 or 3 x 4, such as the previous image's. Only the two images of the map nearest to it are
            compared first, and only points within a tenth of the longer side from their projections. Without a pose the whole map is searched.
        :param orientation: EXIF's, 1, 3, 6 or 8: maps hold upright codes.
        :param mask: H x W uint8, 0 where no points may be found.
        :raises opencv_iib.error: for an image or mask of another size or type, another orientation (no camera sees a mirrored image), or an
            invalid camera."""
        return Location(*self._core.localize(as_image(image), as_camera(camera), None if prior is None else as_pose(prior),
                                             integer(orientation, 'orientation'), as_mask(mask)))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Localizer) and self._arguments == other._arguments

    def __hash__(self) -> int:
        return hash(self._arguments)

    def __reduce__(self) -> Any:
        return Localizer, self._arguments

    def __repr__(self) -> str:
        return 'Localizer({!r}, points={}, lines={})'.format(*self._arguments)
