# Eigen3::Eigen from the system, or from the `cmeel-eigen` build requirement.
find_package(Eigen3 QUIET NO_MODULE)
if(NOT Eigen3_FOUND)
  execute_process(
    COMMAND ${Python_EXECUTABLE} -c "import cmeel.config; print(cmeel.config.cmeel_config.prefix)"
    OUTPUT_VARIABLE cmeel_prefix OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(NOT cmeel_prefix)
    execute_process(
      COMMAND ${Python_EXECUTABLE} -c
              "import importlib.util as u; print(u.find_spec('cmeel').submodule_search_locations[0])"
      OUTPUT_VARIABLE cmeel_package OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
    get_filename_component(cmeel_site "${cmeel_package}" DIRECTORY)
    set(cmeel_prefix "${cmeel_site}/cmeel.prefix")
  endif()
  find_package(Eigen3 REQUIRED NO_MODULE PATHS ${cmeel_prefix})
endif()
message(STATUS "Eigen: found, version ${Eigen3_VERSION}")
