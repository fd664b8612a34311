# Defines Cbc::Cbc, the C interface of COIN-OR's branch and cut. Debian's package has no CMake files of its own.
if(NOT TARGET Cbc::Cbc)
    find_path(CBC_INCLUDE_DIR Cbc_C_Interface.h PATH_SUFFIXES coin REQUIRED)
    find_library(CBC_SOLVER_LIBRARY CbcSolver REQUIRED)
    add_library(Cbc::Cbc UNKNOWN IMPORTED)
    set_target_properties(Cbc::Cbc PROPERTIES
        IMPORTED_LOCATION "${CBC_SOLVER_LIBRARY}"
        INTERFACE_INCLUDE_DIRECTORIES "${CBC_INCLUDE_DIR}")
endif()
