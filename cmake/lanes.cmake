# The vector kernels are compiled once for each instruction set and chosen at run time. They are
# optimised in every build type: unoptimised vector code is too slow even for tests.
set(polhode_lanes ${PROJECT_SOURCE_DIR}/src/polhode/solve/lanes ${PROJECT_SOURCE_DIR}/src/polhode/fe/materials
  ${PROJECT_SOURCE_DIR}/src/polhode/fe/elements)
set(polhode_lane_options -O3 -Wno-psabi -Wno-attributes -Wno-conversion -Wno-ignored-attributes)
foreach(folder ${polhode_lanes})
  set_source_files_properties(${folder}/kernels_baseline.cpp PROPERTIES
    COMPILE_OPTIONS "${polhode_lane_options}" SKIP_PRECOMPILE_HEADERS ON)
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64|amd64")
    set_source_files_properties(${folder}/kernels_avx2.cpp PROPERTIES
      COMPILE_OPTIONS "${polhode_lane_options};-mavx2;-mfma" SKIP_PRECOMPILE_HEADERS ON)
    set_source_files_properties(${folder}/kernels_avx512.cpp PROPERTIES
      COMPILE_OPTIONS "${polhode_lane_options};-mavx512f;-mavx512dq;-mavx512vl;-mavx2;-mfma;-mprefer-vector-width=512"
      SKIP_PRECOMPILE_HEADERS ON)
  endif()
endforeach()
