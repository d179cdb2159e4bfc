# cmake -DSOURCE=.. -DHEADER=.. -P git_hash.cmake: a header with the commit that is built, "unknown" outside git. It is
# written only when that changes, so that nothing is compiled anew for nothing.
set(hash unknown)
find_program(GIT git)
# Sources unpacked into another repository are not that one's.
if(GIT AND EXISTS ${SOURCE}/.git)
  execute_process(COMMAND ${GIT} --no-optional-locks describe --always --dirty --abbrev=12 --exclude=*
                  WORKING_DIRECTORY ${SOURCE} OUTPUT_VARIABLE described RESULT_VARIABLE failed
                  OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(NOT failed)
    set(hash ${described})
  endif()
endif()
file(CONFIGURE OUTPUT ${HEADER} CONTENT "#pragma once\n#define LICHTVELD_GIT_HASH \"${hash}\"\n")
