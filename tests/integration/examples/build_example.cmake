# Builds one example from its installed copy against the installed package, as a user does.
# cmake -DPREFIX=... -DEXAMPLE=... -DBUILD=... -DLAUNCHER=... -P build_example.cmake
set(SHARE ${PREFIX}/share/constrictor)
set(CONFIGURE -S ${SHARE}/examples/${EXAMPLE} -B ${BUILD}/${EXAMPLE} -DCMAKE_PREFIX_PATH=${PREFIX}
              -DCONSTRICTOR_IDL=${SHARE}/idl -DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER} --no-warn-unused-cli)
foreach(arguments
    "${CONFIGURE}"
    "--build;${BUILD}/${EXAMPLE}")
  execute_process(COMMAND ${CMAKE_COMMAND} ${arguments} RESULT_VARIABLE failed)
  if(failed)
    message(FATAL_ERROR "${EXAMPLE}: cmake ${arguments}: ${failed}")
  endif()
endforeach()
