// URDF and SDF files that show a mesh, read by the parsers of ROS and Gazebo.
#include <gtest/gtest.h>
#include <urdf_parser/urdf_parser.h>

#include <sdf/sdf.hh>

#include "robot/description.hpp"
#include "support/project.hpp"

namespace constrictor {
namespace {

TEST(Descriptions, ShowAMeshAndCollideWithTheCapsule) {
  const RobotModel robot = load_robot(testing::robot_path("mamba"));
  const std::string uri = "package://my_robot/a & b/module.stl";
  const auto model = urdf::parseURDF(urdf_model(robot, uri));
  ASSERT_TRUE(model);
  const auto& link = *model->getLink("module_03");
  ASSERT_EQ(link.visual_array.size(), 1u);
  ASSERT_EQ(link.visual->geometry->type, urdf::Geometry::MESH);
  EXPECT_EQ(std::dynamic_pointer_cast<urdf::Mesh>(link.visual->geometry)->filename, uri);
  EXPECT_EQ(link.visual->origin.position.x, link.inertial->origin.position.x) << "the mesh is about the centre";
  EXPECT_EQ(link.collision_array.size(), 3u);

  sdf::Root root;
  ASSERT_TRUE(root.LoadSdfString(sdf_model(robot, uri)).empty());
  ASSERT_NE(root.Model(), nullptr);
  const sdf::Link& module = *root.Model()->LinkByName("module_03");
  ASSERT_EQ(module.VisualByIndex(0)->Geom()->Type(), sdf::GeometryType::MESH);
  EXPECT_EQ(module.VisualByIndex(0)->Geom()->MeshShape()->Uri(), uri);
  EXPECT_EQ(module.CollisionByIndex(0)->Geom()->Type(), sdf::GeometryType::CAPSULE);
}

}  // namespace
}  // namespace constrictor
