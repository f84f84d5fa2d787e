// The MuJoCo model of a robot as text. mujoco_model_test lets MuJoCo itself read it, where MuJoCo is installed.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <regex>
#include <set>

#include "robot/mujoco_model.hpp"
#include "support/project.hpp"

namespace constrictor {
namespace {

/// An element of an XML text with its attributes and the names of the elements around it, from the outermost.
struct Element {
  std::string name;
  std::map<std::string, std::string> attributes;
  std::vector<std::string> parents;
};

/// All elements, in the order in which they begin. The test fails if an element is not closed in the right place.
std::vector<Element> elements_of(const std::string& xml) {
  static const std::regex kTag(R"(<!--[^]*?-->|<(/?)(\w+)((?:\s+\w+="[^"<]*")*)\s*(/?)>)");
  static const std::regex kAttribute(R"_((\w+)="([^"]*)")_");
  std::vector<Element> elements;
  std::vector<std::string> open;
  const std::string between = std::regex_replace(xml, kTag, "");
  EXPECT_EQ(between.find_first_not_of(" \n"), std::string::npos) << "not XML: " << between;
  for (std::sregex_iterator at(xml.begin(), xml.end(), kTag), end; at != end; ++at) {
    const std::string name = (*at)[2];
    if (name.empty()) continue;  // a comment
    if ((*at)[1].length() > 0) {
      EXPECT_FALSE(open.empty() || open.back() != name) << "</" << name << "> closes another element";
      if (!open.empty()) open.pop_back();
      continue;
    }
    Element element{name, {}, open};
    const std::string attributes = (*at)[3];
    for (std::sregex_iterator a(attributes.begin(), attributes.end(), kAttribute); a != end; ++a)
      EXPECT_TRUE(element.attributes.emplace((*a)[1], (*a)[2]).second) << "twice: " << (*a)[1];
    elements.push_back(element);
    if ((*at)[4].length() == 0) open.push_back(name);
  }
  EXPECT_TRUE(open.empty()) << open.back() << " is not closed";
  return elements;
}

std::vector<Element> named(const std::vector<Element>& elements, const std::string& name) {
  std::vector<Element> found;
  for (const Element& element : elements) {
    if (element.name == name) found.push_back(element);
  }
  return found;
}

RobotModel robot(const char* name) { return load_robot(testing::robot_path(name)); }

TEST(MujocoText, HasABodyForEachModuleAndAJointAndAnActuatorForEachJoint) {
  const RobotModel mamba = robot("mamba");
  const auto elements = elements_of(mujoco_model(mamba));
  EXPECT_EQ(elements.front().name, "mujoco");
  EXPECT_EQ(elements.front().attributes.at("model"), "mamba");
  EXPECT_EQ(named(elements, "body").size(), mamba.module_count);
  EXPECT_EQ(named(elements, "geom").size(), mamba.module_count + 1) << "a capsule for each module, and the ground";
  EXPECT_EQ(named(elements, "freejoint").size(), 1u);
  EXPECT_EQ(named(elements, "general").size(), mamba.joints.size());
  EXPECT_EQ(named(elements, "pair").size(), mamba.module_count);
  const auto joints = named(elements, "joint");
  ASSERT_EQ(joints.size(), mamba.joints.size());
  for (std::size_t i = 0; i < joints.size(); ++i) {
    EXPECT_EQ(joints[i].attributes.at("axis"), i % 2 == 0 ? "0 0 -1" : "0 -1 0");
    EXPECT_EQ(std::count(joints[i].parents.begin(), joints[i].parents.end(), "body"), static_cast<long>(i) + 2)
        << "each module hangs on the one ahead of it";
    EXPECT_EQ(std::stod(joints[i].attributes.at("armature")), mamba.joints[i].rotor_inertia_kg_m2);
  }
}

TEST(MujocoText, DividesAnElasticJointIntoMotorAndSpring) {
  const RobotModel serpens = robot("serpens");
  const auto elements = elements_of(mujoco_model(serpens));
  std::set<std::string> joints;
  for (const Element& joint : named(elements, "joint")) {
    if (joint.attributes.contains("name")) joints.insert(joint.attributes.at("name"));
  }
  EXPECT_EQ(joints.size(), 2 * serpens.joints.size());
  EXPECT_TRUE(joints.contains("motor_22") && joints.contains("spring_22"));
  for (const Element& actuator : named(elements, "general"))
    EXPECT_TRUE(actuator.attributes.at("joint").starts_with("motor_")) << actuator.attributes.at("joint");
  EXPECT_EQ(named(elements, "fixed").size(), serpens.joints.size());
}

TEST(MujocoText, IsXmlForAnyNameOfTheRobot) {
  RobotModel strange = robot("mamba");
  strange.name = "a<b> & \"c\"";
  const auto elements = elements_of(mujoco_model(strange));
  EXPECT_EQ(elements.front().attributes.at("model"), "a&lt;b&gt; &amp; &quot;c&quot;");
}

}  // namespace
}  // namespace constrictor
