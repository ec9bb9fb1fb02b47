import os

from conan import ConanFile
from conan.tools.build import check_min_cppstd
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.files import copy, load, rmdir
from conan.tools.scm import Version

required_conan_version = ">=2.0"


class OpenCVIIBConan(ConanFile):
    name = "opencv-iib"
    description = "Illumination-insensitive binary descriptor and hierarchical Hamming matching for OpenCV"
    license = "Apache-2.0"
    topics = ("opencv", "computer-vision", "local-features", "descriptor", "matching")
    package_type = "shared-library"
    settings = "os", "arch", "compiler", "build_type"

    @property
    def _repository(self):
        return os.path.join(self.recipe_folder, "..", "..")

    def set_version(self):
        lists = load(self, os.path.join(self._repository, "CMakeLists.txt"))
        self.version = lists.split("project(opencv_iib VERSION ")[1].split()[0]

    def export_sources(self):
        for pattern in ("CMakeLists.txt", "LICENSE", "cmake/*", "modules/*"):
            copy(self, pattern, self._repository, self.export_sources_folder)

    def layout(self):
        cmake_layout(self, src_folder=".")

    def requirements(self):
        self.requires("opencv/[>=4.6 <5]", transitive_headers=True, transitive_libs=True)

    def validate(self):
        check_min_cppstd(self, 11)

    def package_id(self):
        # OpenCV's classes, which the library inherits from, change between its minor versions.
        self.info.requires["opencv"].minor_mode()

    def generate(self):
        toolchain = CMakeToolchain(self)
        toolchain.cache_variables["IIB_BUILD_TESTS"] = False
        toolchain.cache_variables["IIB_BUILD_TOOLS"] = False
        toolchain.generate()
        CMakeDeps(self).generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build(target="opencv_iib_index")

    def package(self):
        copy(self, "LICENSE", self.source_folder, os.path.join(self.package_folder, "licenses"))
        CMake(self).install()
        rmdir(self, os.path.join(self.package_folder, "lib", "cmake"))
        rmdir(self, os.path.join(self.package_folder, "lib", "pkgconfig"))

    def package_info(self):
        self.cpp_info.set_property("cmake_file_name", "opencv_iib")
        self.cpp_info.set_property("cmake_target_name", "opencv_iib")
        self.cpp_info.set_property("pkg_config_name", "opencv_iib")
        self.cpp_info.libs = ["opencv_iib_index", "opencv_iib"]
        self.cpp_info.includedirs = [os.path.join("include", "opencv4")]
        features = "features2d" if Version(self.dependencies["opencv"].ref.version) < "5" else "features"
        self.cpp_info.requires = ["opencv::opencv_core", "opencv::opencv_imgproc", "opencv::opencv_" + features]
