"""Long-term visual localization on COLMAP models. See doc/maps.md."""
from opencv_iib._camera import Camera
from opencv_iib.localization.localizer import Localizer, Location
from opencv_iib.localization.maps import build, update
from opencv_iib.localization.run import find_camera, localize_images, localize_stream
from opencv_iib.localization.imu import smooth_poses

__all__ = ['Camera', 'Localizer', 'Location', 'build', 'find_camera', 'localize_images', 'localize_stream', 'smooth_poses', 'update']
