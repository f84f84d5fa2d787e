// Each file opens only the namespaces of its folder.
#include <gtest/gtest.h>

#include "layout_check.hpp"
#include "source_tree.hpp"
#include "support/project.hpp"

namespace constrictor::testing {
namespace {

TEST(Layout, FilesAreInTheNamespacesOfTheirFolders) {
  EXPECT_EQ(text_of(namespace_violations(source_path())), "")
      << "Accepted are constrictor and constrictor::FOLDER; CONTRIBUTING.md (Names) has the exceptions.";
}

TEST(LayoutChecker, FindsNamespacesOfOtherFolders) {
  const Tree tree;
  const auto opens = [](const std::string& name) { return "namespace " + name + " {\n}  // namespace " + name + "\n"; };
  tree.add("components/tools/cli/keys/good.cpp", "namespace CLI {\nclass App;\n}\n" + opens("constrictor::cli"));
  tree.add("components/lib/cyclone/good.cpp", opens("constrictor") + opens("constrictor::dds::primitives"));
  tree.add("components/lib/runtime/good.cpp",
           "namespace constrictor {\nnamespace {\nnamespace fs = std::filesystem;\n}\nnamespace exit_status {\n}\n}\n");
  tree.add("tests/unit/runtime/good_test.cpp", opens("constrictor::dds"));
  tree.add("tests/unit/runtime/fixture.hpp", opens("constrictor::testing"));
  tree.add("tests/unit/layout/good_test.cpp", opens("constrictor::testing"));
  tree.add("tests/integration/good_test.cpp", opens("constrictor::testing"));
  tree.add("components/lib/runtime/a.cpp", "\n" + opens("constrictor::dds"));
  tree.add("components/lib/runtime/b.hpp", "namespace constrictor {\nnamespace dds {\n");
  tree.add("components/lib/runtime/c.hpp", opens("constrictor::testing"));
  tree.add("components/lib/cyclone/d.hpp", opens("constrictor::cyclone"));
  tree.add("sim/world/e.cpp", opens("constrictor") + opens("helpers"));
  tree.add("tests/unit/runtime/f_test.cpp", opens("constrictor::testing"));
  tree.add("tests/support/g.hpp", opens("constrictor::toys"));
  EXPECT_EQ(text_of(namespace_violations(tree.root())),
            "components/lib/cyclone/d.hpp:1: opens namespace constrictor::cyclone\n"
            "components/lib/runtime/a.cpp:2: opens namespace constrictor::dds\n"
            "components/lib/runtime/b.hpp:2: opens namespace dds\n"
            "components/lib/runtime/c.hpp:1: opens namespace constrictor::testing\n"
            "sim/world/e.cpp:3: opens namespace helpers\n"
            "tests/support/g.hpp:1: opens namespace constrictor::toys\n"
            "tests/unit/runtime/f_test.cpp:1: opens namespace constrictor::testing\n");
}

}  // namespace
}  // namespace constrictor::testing
