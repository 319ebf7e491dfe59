# Eigen3::Eigen from the system, else from the `cmeel-eigen` build requirement.
find_package(Eigen3 QUIET NO_MODULE)
if(NOT Eigen3_FOUND)
  execute_process(
    COMMAND ${Python_EXECUTABLE} -c
            "import cmeel, pathlib; print(pathlib.Path(cmeel.__file__).parents[1] / 'cmeel.prefix')"
    OUTPUT_VARIABLE cmeel_prefix OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  find_package(Eigen3 QUIET NO_MODULE PATHS ${cmeel_prefix} NO_DEFAULT_PATH)
endif()
if(NOT Eigen3_FOUND)
  message(FATAL_ERROR "Eigen: not found. Install libeigen3-dev (Debian), or cmeel-eigen with pip.")
endif()
message(STATUS "Eigen: found, version ${Eigen3_VERSION}, in ${Eigen3_DIR}")
