// The main function of the benchmarks whose result depends on the numeric environment of a run.
#include <benchmark/benchmark.h>

#include "runtime/numeric_profile.hpp"

int main(int argc, char** argv) {
  constrictor::ensure_numeric_environment(argv);  // as in a run
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
