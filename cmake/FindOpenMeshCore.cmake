# Defines OpenMesh::Core. Debian's OpenMesh 9.0 exports no usable target name of its own in every version, so look for the
# one header and the one library that we need.
if(NOT TARGET OpenMesh::Core)
    find_path(OPENMESH_INCLUDE_DIR OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh REQUIRED)
    find_library(OPENMESH_CORE_LIBRARY OpenMeshCore REQUIRED)
    add_library(OpenMesh::Core UNKNOWN IMPORTED)
    set_target_properties(OpenMesh::Core PROPERTIES
        IMPORTED_LOCATION "${OPENMESH_CORE_LIBRARY}"
        INTERFACE_INCLUDE_DIRECTORIES "${OPENMESH_INCLUDE_DIR}")
endif()
