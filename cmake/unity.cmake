# Unity builds: several source files of a folder are compiled as one, so that the headers that they
# share, most of the cost, are read once. Names in anonymous namespaces are unique within a folder.
option(POLHODE_UNITY "Compile several source files of a folder as one" ${PROJECT_IS_TOP_LEVEL})

# polhode_unity(TARGET BATCH FILES...): files with options of their own stay alone.
function(polhode_unity target batch)
  if(NOT POLHODE_UNITY)
    return()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  # Types of anonymous namespaces within a class of the same file, which now is an included one.
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
  set(groups)
  foreach(file ${ARGN})
    get_source_file_property(alone ${file} SKIP_UNITY_BUILD_INCLUSION)
    if(alone)
      continue()
    endif()
    get_filename_component(folder ${file} DIRECTORY)
    string(REGEX REPLACE "^${PROJECT_SOURCE_DIR}/" "" folder "${folder}")
    string(MAKE_C_IDENTIFIER "${folder}" group)
    if(NOT DEFINED count_${group})
      set(count_${group} 0)
    endif()
    math(EXPR part "${count_${group}} / ${batch}")
    math(EXPR count_${group} "${count_${group}} + 1")
    set_source_files_properties(${file} PROPERTIES UNITY_GROUP ${group}_${part})
  endforeach()
endfunction()
