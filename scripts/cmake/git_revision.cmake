# Writes a C++ file with the git revision of the source tree, only if it has changed, because programs are linked again
# after that. cmake -DSOURCE=FOLDER -DFILE=FILE -P git_revision.cmake
set(revision "not known: not built in a git repository")
set(date "")
execute_process(COMMAND git -C ${SOURCE} log -1 --abbrev=12 --format=%h,%cs
                OUTPUT_VARIABLE found OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
# An unpacked archive inside of another project's repository is not that project.
execute_process(COMMAND git -C ${SOURCE} rev-parse --show-toplevel
                OUTPUT_VARIABLE top OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT failed AND top STREQUAL SOURCE AND found MATCHES "^([0-9a-f]+),([0-9-]+)$")
  set(revision "${CMAKE_MATCH_1} of ${CMAKE_MATCH_2}")
  set(date "${CMAKE_MATCH_2}")
  execute_process(COMMAND git -C ${SOURCE} status --porcelain --untracked-files=no
                  OUTPUT_VARIABLE changes ERROR_QUIET)
  if(changes)
    string(APPEND revision ", with changes that are not committed")
  endif()
endif()
file(CONFIGURE OUTPUT ${FILE} CONTENT [[
// Made by scripts/cmake/git_revision.cmake.
namespace constrictor {
extern const char* const kGitRevision;
extern const char* const kGitDate;
const char* const kGitRevision = "@revision@";
const char* const kGitDate = "@date@";
}  // namespace constrictor
]] @ONLY)
