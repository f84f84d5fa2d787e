#include "runtime/component_main.hpp"
#include "sim/report/report.hpp"

int main(int argc, char** argv) { return constrictor::component_main(argc, argv, constrictor::make_report_factory()); }
