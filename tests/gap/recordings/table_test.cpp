// Tables of other programs, as they write them: what is recognised, read, left out and said.
#include "gap/recordings/table.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "gap/recordings/iso_date.hpp"
#include "gap/recordings/recording_error.hpp"

using namespace kenaf::gap::recordings;

namespace table_test {
namespace {

Table parsed(const std::string& text) {
  return parse_table(text, "table.csv");
}

std::vector<double> column(const Table& table, const std::string& name) {
  const auto values = table.column(name);
  return {values.begin(), values.end()};
}

bool says(const Table& table, const std::string& words) {
  for (const std::string& remark : table.remarks)
    if (remark.find(words) != std::string::npos) return true;
  return false;
}

}  // namespace

TEST_CASE("An export of Motive gives its bodies, in its units, and counts the markers") {
  const Table table = parsed(
      "Format Version,1.23,Take Name,T,Capture Frame Rate,120.000000,Rotation Type,Quaternion,Length "
      "Units,Millimeters\n"
      "\n"
      ",,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body Marker,"
      "Rigid Body Marker,Rigid Body Marker\n"
      ",,Robot,Robot,Robot,Robot,Robot,Robot,Robot,Robot,\"Robot:Marker, 1\",\"Robot:Marker, 1\",\"Robot:Marker, 1\"\n"
      ",,A1,A1,A1,A1,A1,A1,A1,A1,B1,B1,B1\n"
      ",,Rotation,Rotation,Rotation,Rotation,Position,Position,Position,Mean Marker Error,Position,Position,Position\n"
      "Frame,Time (Seconds),X,Y,Z,W,X,Y,Z,,X,Y,Z\n"
      "0,0.000000,0,0,0,1,100,200,300,0.5,1,2,3\n"
      "1,0.008333,0,0.1,0,0.995,,,,,1,2,3\n");
  CHECK(table.form == "Motive");
  CHECK(table.time_column == "Time (Seconds)");
  CHECK(column(table, "Time (Seconds)") == std::vector<double>{0, 0.008333});
  REQUIRE(table.poses.size() == 1);
  const TablePose& pose = table.poses[0];
  CHECK(pose.body == "Robot");
  CHECK(pose.position == std::array<std::string, 3>{"Robot.Position.X", "Robot.Position.Y", "Robot.Position.Z"});
  CHECK(pose.rotation ==
        std::vector<std::string>{"Robot.Rotation.X", "Robot.Rotation.Y", "Robot.Rotation.Z", "Robot.Rotation.W"});
  CHECK(pose.order == "quaternion");
  CHECK(pose.unit == "mm");
  CHECK(pose.up == kenaf::gap::logs::Up::y);
  CHECK(column(table, "Robot.Position.Z")[0] == 300);
  CHECK(std::isnan(column(table, "Robot.Position.Z")[1]));
  CHECK(column(table, "Robot.Rotation.W") == std::vector<double>{1, 0.995});
  CHECK(says(table, "3 columns of 'Rigid Body Marker' are not read"));
  CHECK(says(table, "1 columns of 'Rigid Body, Mean Marker Error' are not read"));
  CHECK(table.columns.size() == 8);  // time, 4 and 3
}

TEST_CASE("An export of Vicon gives rotation vectors or quaternions, and times by its frames") {
  const Table table = parsed(
      "Segments\n200\n,,Robot:Robot,,,,,,Box:Box,,,,,\nFrame,Sub Frame,RX,RY,RZ,TX,TY,TZ,RX,RY,RZ,TX,TY,TZ\n"
      ",,deg,deg,deg,mm,mm,mm,deg,deg,deg,mm,mm,mm\n"
      "11,0,0,0,90,1,2,3,0,0,0,7,8,9\n13,0,0,0,91,4,5,6,0,0,0,7,8,9\n\nTrajectories\n200\n");
  CHECK(table.form == "Vicon");
  CHECK(column(table, "time_s") == std::vector<double>{11 / 200.0, 13 / 200.0});
  REQUIRE(table.poses.size() == 2);
  CHECK(table.poses[0].order == "vector");
  CHECK(table.poses[0].angle_unit == "deg");
  CHECK(table.poses[1].position[0] == "Box:Box.TX");
  CHECK(column(table, "Robot:Robot.RZ") == std::vector<double>{90, 91});
  CHECK(says(table, "2 lines behind the first section are not read"));

  const Table turned = parsed(
      "Objects\n100\n,,Robot:Robot,,,,,,\nFrame,Sub Frame,RX,RY,RZ,RW,TX,TY,TZ\n,,,,,,mm,mm,mm\n1,0,0,0,0,1,1,2,3\n");
  REQUIRE(turned.poses.size() == 1);
  CHECK(turned.poses[0].order == "quaternion");
  CHECK(turned.poses[0].rotation.back() == "Robot:Robot.RW");
}

TEST_CASE("An export of Qualisys gives angles in the order roll, pitch, yaw, and takes zeros as not seen") {
  const Table table = parsed(
      "NO_OF_FRAMES\t3\nNO_OF_BODIES\t1\nFREQUENCY\t100\nDATA_INCLUDED\t6D\nBODY_NAMES\trobot\n"
      "robot X\tY\tZ\tRoll\tPitch\tYaw\tResidual\tRot[0]\n"
      "1000.0\t-20.5\t90\t1\t2\t45\t0.3\t1\n0.0\t0.0\t0.0\t0\t0\t0\t-1\t0\n1001\t-20\t90\t1\t2\t46\t0.3\t1\n");
  CHECK(table.form == "Qualisys");
  CHECK(column(table, "time_s") == std::vector<double>{0, 0.01, 0.02});
  REQUIRE(table.poses.size() == 1);
  CHECK(table.poses[0].order == "xyz");
  CHECK(table.poses[0].rotation == std::vector<std::string>{"robot.Roll", "robot.Pitch", "robot.Yaw"});
  CHECK(column(table, "robot.X")[0] == 1000);
  CHECK(std::isnan(column(table, "robot.X")[1]));
  CHECK(says(table, "1 rows in which robot is at 0, 0, 0 are taken as not seen"));
}

TEST_CASE("Trajectories of TUM and EuRoC are recognised by their rows and header") {
  const Table tum = parsed(
      "# ground truth\n# timestamp tx ty tz qx qy qz qw\n1305031098.6659 1.35  0.63 1.65 0 0 0.6 0.8\n"
      "1305031098.6758 1.36\t0.63 1.65 0 0 0.6 0.8\n");
  CHECK(tum.form == "TUM");
  CHECK(tum.time_column == "timestamp");
  CHECK(column(tum, "tx") == std::vector<double>{1.35, 1.36});
  CHECK(tum.poses[0].rotation == std::vector<std::string>{"qx", "qy", "qz", "qw"});

  const Table euroc = parsed(
      "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z []\n"
      "1403636580838555648,4.68,-1.78,0.78,0.53,-0.15,-0.82,-0.08\n1403636580843555648,4.69,-1.78,0.78,0.53,-0.15,-0."
      "82,-0.08\n");
  CHECK(euroc.form == "EuRoC");
  CHECK(euroc.time_column == "timestamp");
  REQUIRE(euroc.poses.size() == 1);
  CHECK(euroc.poses[0].rotation == std::vector<std::string>{"q_RS_x []", "q_RS_y []", "q_RS_z []", "q_RS_w []"});

  const Table imu = parsed(
      "#timestamp [ns],w_RS_S_x [rad s^-1],a_RS_S_x [m "
      "s^-2]\n1403636579758555392,-0.1,9.1\n1403636579763555584,-0.1,9.2\n");
  CHECK(imu.time_unit == "ns");
  CHECK(imu.poses.empty());
}

TEST_CASE("CSV of rostopic, PlotJuggler and pandas are named, with their column of time") {
  const Table rostopic = parsed(
      "%time,field.header.seq,field.header.stamp,field.header.frame_id,field.twist.linear.x\n"
      "1600000000003000000,1,1600000000000000000,base_link,0.5\n1600000000053000000,2,1600000000050000000,base_link,0."
      "6\n");
  CHECK(rostopic.form == "CSV of rostopic");
  CHECK(rostopic.time_column == "%time");
  CHECK(rostopic.time_unit == "ns");
  CHECK(column(rostopic, "field.twist.linear.x") == std::vector<double>{0.5, 0.6});
  CHECK(says(rostopic, "2 cells of text in 1 columns are left out, the first is 'base_link'"));
  CHECK(std::ranges::find(rostopic.columns, "field.header.frame_id") == rostopic.columns.end());

  const Table juggler = parsed("__time,/cmd_vel/linear/x,/odom/pose/position/x\n1.5,0.1,\n1.6,,2\n");
  CHECK(juggler.form == "CSV of PlotJuggler");
  CHECK(juggler.time_column == "__time");
  CHECK(std::isnan(column(juggler, "/cmd_vel/linear/x")[1]));

  const Table pandas = parsed(",left,right\n2024-05-01 12:00:00.250,1,2\n2024-05-01T12:00:01+02:00,3,NaN\n");
  CHECK(pandas.form == "CSV of pandas");
  CHECK(pandas.time_column == "index");
  // 2024-05-01 is day 19844 since 1970; 12:00 with +02:00 is 10:00 UTC.
  CHECK(column(pandas, "index") == std::vector<double>{19844 * 86400.0 + 43200.25, 19844 * 86400.0 + 36001});
  CHECK(says(pandas, "") == false);
}

TEST_CASE("Semicolons, decimal commas, quotes, comments, marks and line ends of other systems are read") {
  const Table table =
      parsed("\xEF\xBB\xBF# made by a logger\r\n\"time\";\"speed [m/s]\";on\r\n0,5;\"1,25\";true\r\n1,5;-2;false\r\n");
  CHECK(column(table, "time") == std::vector<double>{0.5, 1.5});
  CHECK(column(table, "speed [m/s]") == std::vector<double>{1.25, -2});
  CHECK(column(table, "on") == std::vector<double>{1, 0});
  CHECK(says(table, "semicolons between the cells"));
  CHECK(says(table, "decimal commas"));
}

TEST_CASE("Times without a unit in their name have that which the times show") {
  std::string text = "timestamp,a\n";
  for (int i = 0; i < 12; ++i) text += std::to_string(1700000000000LL + 10 * i) + ",1\n";
  CHECK(parsed(text).time_unit == "ms");
  CHECK(parsed("timestamp,a\n1,1\n2,1\n").time_unit == "s");
}

TEST_CASE("Rows of another length, texts and two columns of one name lose nothing and are said") {
  const Table table = parsed("t,a,a\n0,1,2\n1,3\n2,4,5,6\n3,error,7\n");
  CHECK(table.columns == std::vector<std::string>{"t", "a", "a (2)"});
  CHECK(column(table, "t") == std::vector<double>{0, 1, 2, 3});
  CHECK(std::isnan(column(table, "a (2)")[1]));
  CHECK(says(table, "2 rows have another count of cells than the header"));
  CHECK(says(table, "1 cells of text in 1 columns are left out, the first is 'error'"));
}

TEST_CASE("What is no table is refused with the file's name and what is missing") {
  for (const char* text : {"", "\n\n", "1,2,3\n4,5,6\n", "one\n2\n", "t,a\n", "Format Version,1.23\nFrame,Time\n0,0\n",
                           "Segments\n200\na\nb\nc\nd\n", "NO_OF_FRAMES\t1\nMARKER_NAMES\ta\n1\t2\t3\n"}) {
    INFO(text);
    CHECK_THROWS_WITH(parsed(text), Catch::StartsWith("table.csv"));
  }
}

TEST_CASE("Bodies that lack a column, and names that a mapping cannot hold, make no pose") {
  const Table table = parsed(
      "NO_OF_FRAMES\t1\nFREQUENCY\t100\nBODY_NAMES\tr\tr\nr X\tY\tZ\tRoll\tPitch\tYaw\tr X\tY\tRoll\tPitch\tYaw\n"
      "1\t2\t3\t4\t5\t6\t0\t0\t0\t0\t0\n");
  CHECK(table.poses.size() == 2);  // of one name, so both have the columns of the first
  CHECK(parsed("NO_OF_FRAMES\t1\nFREQUENCY\t100\nBODY_NAMES\tr\nr X\tY\tRoll\tPitch\tYaw\n1\t2\t4\t5\t6\n")
            .poses.empty());
}

TEST_CASE("Dates that are none are no dates") {
  CHECK(seconds_of_date("1970-01-02 00:00:00Z") == 86400);
  for (const char* text : {"", "2024", "2024-13-01 00:00:00", "2024-02-30 00:00:00", "2024-01-01 25:00:00",
                           "2024-01-01 00:00:00x", "2024-01-01 00:00:00+2", "20240101 000000"})
    CHECK_FALSE(seconds_of_date(text));
}

}  // namespace table_test
