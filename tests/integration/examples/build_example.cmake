# Builds one example from its installed copy, against the installed package: what a user does by hand.
# cmake -DPREFIX=... -DEXAMPLE=... -DBUILD=... -DLAUNCHER=... -P build_example.cmake
foreach(arguments
    "-S;${PREFIX}/share/constrictor/examples/${EXAMPLE};-B;${BUILD}/${EXAMPLE};-DCMAKE_PREFIX_PATH=${PREFIX};-DCONSTRICTOR_IDL=${PREFIX}/share/constrictor/idl;-DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER};--no-warn-unused-cli"
    "--build;${BUILD}/${EXAMPLE}")
  execute_process(COMMAND ${CMAKE_COMMAND} ${arguments} RESULT_VARIABLE failed)
  if(failed)
    message(FATAL_ERROR "${EXAMPLE}: cmake ${arguments}: ${failed}")
  endif()
endforeach()
