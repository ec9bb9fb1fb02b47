"""Long-term visual localization on COLMAP models; the geometry is pycolmap's. See doc/maps.md."""
from opencv_iib.localization.build import build_map
from opencv_iib.localization.localizer import Localizer, Location
from opencv_iib.localization.map import Map, read_map
from opencv_iib.localization.run import find_camera, localize_images, parse_camera
from opencv_iib.localization.update import update_map

__all__ = ['Localizer', 'Location', 'Map', 'build_map', 'find_camera', 'localize_images', 'parse_camera', 'read_map',
           'update_map']
