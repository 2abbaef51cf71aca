# The vector kernels are compiled once for each instruction set and chosen at run time. They are
# optimised in every build type: unoptimised vector code is too slow even for tests.
set(polhode_lanes ${PROJECT_SOURCE_DIR}/src/polhode/kernels ${PROJECT_SOURCE_DIR}/src/polhode/solids/materials
  ${PROJECT_SOURCE_DIR}/src/polhode/solids/elements)
set(polhode_lane_options -O3 -Wno-psabi -Wno-attributes -Wno-conversion -Wno-ignored-attributes)
if(POLHODE_SANITIZE)
  # With all checks at -O3 the compiler needs ten minutes a file. Addresses are checked all the same.
  list(TRANSFORM polhode_lane_options REPLACE "-O3" "-O1")
  list(APPEND polhode_lane_options -fno-sanitize=null,alignment,object-size)
endif()
foreach(folder ${polhode_lanes})
  set_source_files_properties(${folder}/kernels_baseline.cpp PROPERTIES
    COMPILE_OPTIONS "${polhode_lane_options}" SKIP_UNITY_BUILD_INCLUSION ON SKIP_PRECOMPILE_HEADERS ON)
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64|amd64")
    set_source_files_properties(${folder}/kernels_avx2.cpp PROPERTIES
      COMPILE_OPTIONS "${polhode_lane_options};-mavx2;-mfma" SKIP_UNITY_BUILD_INCLUSION ON SKIP_PRECOMPILE_HEADERS ON)
    set_source_files_properties(${folder}/kernels_avx512.cpp PROPERTIES
      COMPILE_OPTIONS "${polhode_lane_options};-mavx512f;-mavx512dq;-mavx512vl;-mavx2;-mfma;-mprefer-vector-width=512"
      SKIP_UNITY_BUILD_INCLUSION ON SKIP_PRECOMPILE_HEADERS ON)
  endif()
endforeach()
