#include "server/image_server/drawing.hpp"

#include "camera/robot_cameras.hpp"

namespace kenaf::image_server {

std::shared_ptr<const CameraImage> Drawing::draw(const camera::Scene& scene, const Exposure& exposure,
                                                 std::size_t robot_index, std::size_t camera_index, PictureSize size,
                                                 camera::JpegEncoder& encoder) {
  const double field_of_view_rad = exposure.field_of_view_rad[robot_index][camera_index];
  if (image_ && field_of_view_rad_ == field_of_view_rad && look_alike(world_, exposure.world)) return image_;

  const camera::RobotSnapshot& robot = exposure.world.robots[robot_index];
  const physics::CameraDescription& camera = robot.description->cameras[camera_index];
  camera::View view = camera::camera_view(robot, camera, field_of_view_rad);
  if (size == PictureSize::half) view.lens = camera::half_size(view.lens);
  if (!renderer_) renderer_ = std::make_unique<camera::Renderer>();
  const auto image = std::make_shared<CameraImage>();
  renderer_->render(scene, view, image->picture);
  const auto jpeg = encoder.encode(image->picture, camera.jpeg_quality);
  image->jpeg.assign(jpeg.begin(), jpeg.end());

  image_ = image;
  world_ = exposure.world;
  field_of_view_rad_ = field_of_view_rad;
  return image_;
}

}  // namespace kenaf::image_server
