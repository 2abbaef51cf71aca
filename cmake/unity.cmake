# Unity builds: several source files of a folder are compiled as one, so that the headers that they
# share, most of the cost, are read once. Names in anonymous namespaces are unique within a folder.
option(POLHODE_UNITY "Compile several source files of a folder as one" ${PROJECT_IS_TOP_LEVEL})

# polhode_unity(TARGET ROOT BATCH FILES...): files with options of their own stay alone. The files
# are included by their names below ROOT, so that a compiler cache serves every checkout: CMake's
# own unity builds write the checkout's folder into each file. Folders in the target's property
# POLHODE_RUNS_ONCE, whose code runs once in a run, are optimised less: a fifth cheaper to compile.
function(polhode_unity target root batch)
  if(NOT POLHODE_UNITY)
    return()
  endif()
  # Types of anonymous namespaces within a class of the same file, which now is an included one.
  # Clang takes names of two anonymous namespaces for a shadow.
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>
    $<$<CXX_COMPILER_ID:Clang>:-Wno-shadow>)
  target_include_directories(${target} PRIVATE ${root})
  set(units)
  foreach(file ${ARGN})
    get_source_file_property(alone ${file} SKIP_UNITY_BUILD_INCLUSION)
    if(alone)
      continue()
    endif()
    file(RELATIVE_PATH name ${root} ${file})
    get_filename_component(folder ${name} DIRECTORY)
    if(NOT folder)
      set(folder ${target})
    endif()
    string(MAKE_C_IDENTIFIER "${folder}" group)
    if(NOT DEFINED count_${group})
      set(count_${group} 0)
    endif()
    math(EXPR part "${count_${group}} / ${batch}")
    math(EXPR count_${group} "${count_${group}} + 1")
    set(unit ${CMAKE_CURRENT_BINARY_DIR}/unity/${target}/${group}_${part}.cpp)
    string(APPEND text_${group}_${part} "#include \"${name}\"\n")
    set(content_of_${unit} "${text_${group}_${part}}")
    list(APPEND units ${unit})
    set_source_files_properties(${file} PROPERTIES HEADER_FILE_ONLY ON)
  endforeach()
  list(REMOVE_DUPLICATES units)
  get_target_property(seldom ${target} POLHODE_RUNS_ONCE)
  foreach(folder ${seldom})
    string(MAKE_C_IDENTIFIER "${folder}" group)
    set(of_folder ${units})
    list(FILTER of_folder INCLUDE REGEX "/${group}_[0-9]+\\.cpp$")
    set_source_files_properties(${of_folder} PROPERTIES COMPILE_OPTIONS
      $<$<AND:$<CXX_COMPILER_ID:GNU,Clang>,$<CONFIG:Release>>:-O1>)
  endforeach()
  foreach(unit ${units})
    file(CONFIGURE OUTPUT ${unit} CONTENT "${content_of_${unit}}" @ONLY)  # written only if it changes
  endforeach()
  target_sources(${target} PRIVATE ${units})
endfunction()
