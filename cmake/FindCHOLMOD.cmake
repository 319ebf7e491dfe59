# CHOLMOD of SuiteSparse: CHOLMOD::CHOLMOD, CHOLMOD_VERSION. Debian's package has no CMake config.
find_path(CHOLMOD_INCLUDE_DIR cholmod.h PATH_SUFFIXES suitesparse)
find_library(CHOLMOD_LIBRARY cholmod)

if(CHOLMOD_INCLUDE_DIR)
  file(STRINGS ${CHOLMOD_INCLUDE_DIR}/cholmod.h version_lines
       REGEX "#define CHOLMOD_(MAIN|SUB|SUBSUB)_VERSION +[0-9]+")
  # cholmod.h of SuiteSparse 5 includes cholmod_core.h, where the numbers stand
  if(NOT version_lines AND EXISTS ${CHOLMOD_INCLUDE_DIR}/cholmod_core.h)
    file(STRINGS ${CHOLMOD_INCLUDE_DIR}/cholmod_core.h version_lines
         REGEX "#define CHOLMOD_(MAIN|SUB|SUBSUB)_VERSION +[0-9]+")
  endif()
  string(REGEX MATCHALL "VERSION +[0-9]+" version_parts "${version_lines}")
  list(TRANSFORM version_parts REPLACE "VERSION +" "")
  list(JOIN version_parts "." CHOLMOD_VERSION)
endif()

include(FindPackageHandleStandardArgs)
set(FPHS_quiet ${CHOLMOD_FIND_QUIETLY})
set(CHOLMOD_FIND_QUIETLY TRUE)
find_package_handle_standard_args(CHOLMOD REQUIRED_VARS CHOLMOD_LIBRARY CHOLMOD_INCLUDE_DIR
                                  VERSION_VAR CHOLMOD_VERSION)
set(CHOLMOD_FIND_QUIETLY ${FPHS_quiet})

if(CHOLMOD_FOUND)
  message(STATUS "CHOLMOD: found, version ${CHOLMOD_VERSION}")
  if(NOT TARGET CHOLMOD::CHOLMOD)
    add_library(CHOLMOD::CHOLMOD UNKNOWN IMPORTED)
    set_target_properties(CHOLMOD::CHOLMOD PROPERTIES IMPORTED_LOCATION ${CHOLMOD_LIBRARY}
                                                      INTERFACE_INCLUDE_DIRECTORIES ${CHOLMOD_INCLUDE_DIR})
  endif()
else()
  message(STATUS "CHOLMOD: not found; the reference solver is off (Debian: libsuitesparse-dev)")
endif()
mark_as_advanced(CHOLMOD_INCLUDE_DIR CHOLMOD_LIBRARY)
