# Writes the commit of the sources into a C header, which changes only if the commit does; sources without git: "unknown".
# cmake -DSOURCE=<folder of the sources> -DOUTPUT=<file> -P build_facts.cmake
set(commit unknown)
find_program(git git)
if(git AND EXISTS ${SOURCE}/.git)
  execute_process(COMMAND ${git} -C ${SOURCE} describe --always --dirty --abbrev=12 --exclude=* OUTPUT_VARIABLE found
                  OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE status ERROR_QUIET)
  if(status EQUAL 0 AND found)
    set(commit ${found})
  endif()
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "#define BUILD_COMMIT \"${commit}\"\n")
