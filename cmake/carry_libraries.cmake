# Install script: copies the shared libraries of a program, and of MUMPS, into lib/polhode beside it, with the licences
# their Debian packages state. Of the system remains the C library. Needs: program, mumps, mumps_name.
set(prefix "$ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}")
set(libraries "${prefix}/lib/polhode")
set(licences "${prefix}/share/doc/polhode/licenses")
file(GET_RUNTIME_DEPENDENCIES EXECUTABLES "${program}" LIBRARIES "${mumps}"
  RESOLVED_DEPENDENCIES_VAR found
  PRE_EXCLUDE_REGEXES "^ld-linux" "^lib(c|m|dl|rt|pthread|resolv|util)\\.so")
file(MAKE_DIRECTORY "${libraries}" "${licences}")
find_program(DPKG_QUERY dpkg-query)

# carry(FILE NAME): copy of a library under the name that programs load it by.
function(carry file name)
  file(REAL_PATH "${file}" real)
  file(COPY_FILE "${real}" "${libraries}/${name}")
  if(DPKG_QUERY)
    string(REGEX REPLACE "^/usr" "" old_path "${real}")  # of packages older than the merge of /lib and /usr/lib
    execute_process(COMMAND ${DPKG_QUERY} -S "${real}" "${old_path}" OUTPUT_VARIABLE owner ERROR_QUIET)
    string(REGEX REPLACE ":.*" "" owner "${owner}")
    if(owner AND EXISTS "/usr/share/doc/${owner}/copyright")
      file(COPY_FILE "/usr/share/doc/${owner}/copyright" "${licences}/${owner}.txt")
    endif()
  endif()
endfunction()

# The texts that these refer to, which other systems do not have at that place.
function(copy_common_licences)
  file(GLOB statements "${licences}/*.txt")
  foreach(statement IN LISTS statements)
    file(READ "${statement}" words)
    string(REGEX MATCHALL "/usr/share/common-licenses/[-A-Za-z0-9.]*[A-Za-z0-9]" texts "${words}")
    foreach(text IN LISTS texts)
      get_filename_component(name "${text}" NAME)
      file(REAL_PATH "${text}" real)
      if(EXISTS "${real}")
        file(COPY_FILE "${real}" "${licences}/${name}.txt")
      endif()
    endforeach()
  endforeach()
endfunction()

carry("${mumps}" "${mumps_name}")
foreach(library IN LISTS found)
  get_filename_component(name "${library}" NAME)
  carry("${library}" "${name}")
endforeach()
copy_common_licences()
