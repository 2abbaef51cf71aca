# Warnings are errors in our tests, where scripts/test.sh sets POLHODE_WERROR; users may have newer compilers.
function(polhode_enable_warnings target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
    $<$<BOOL:${POLHODE_WERROR}>:-Werror>
    $<$<CXX_COMPILER_ID:Clang>:-Wno-overlength-strings>  # the viewer's page, a string of the program
    # GCC 12 reports std::string concatenation and Eigen's small maps as overlapping or uninitialised (false positives).
    $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-restrict -Wno-array-bounds -Wno-maybe-uninitialized -Wno-stringop-overflow>)
endfunction()
