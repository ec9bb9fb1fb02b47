"""COLMAP and hloc: whole collections of images, described and matched. See doc/colmap.md."""
from opencv_iib.colmap.database import SettingsChanged
from opencv_iib.colmap.pipeline import Options, build_database
from opencv_iib.features import FeatureOptions

__all__ = ['FeatureOptions', 'Options', 'SettingsChanged', 'build_database']
