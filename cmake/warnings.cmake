# Warnings are errors for us, never for a project that builds us as a subproject.
function(polhode_enable_warnings target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
    $<$<BOOL:${PROJECT_IS_TOP_LEVEL}>:-Werror>
    # GCC 12 reports std::string concatenation and Eigen's small maps as overlapping or uninitialised (false positives).
    $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-restrict -Wno-array-bounds -Wno-maybe-uninitialized -Wno-stringop-overflow>)
endfunction()
