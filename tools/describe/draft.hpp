// A robot's TOML file before it is written: tables of numbers, each with where it comes from.
//
// Thread safety: values and pure functions.
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

namespace kenaf::describe {

enum class Source { urdf, chosen, given };

struct Entry {
  std::string key, value;  // the value as TOML
  Source source;
  std::string comment;  // behind "chosen: ", or behind "URDF: "; may be empty
};

struct Table {
  std::string name;             // "body"; empty: the top of the file
  bool one_of_several = false;  // [[wheel]]
  std::vector<Entry> entries;

  void add(std::string key, std::string value, Source source, std::string comment = {});
  void from_urdf(std::string key, std::string value, std::string comment = {});
  void chosen(std::string key, std::string value, std::string comment = {});
};

struct Draft {
  std::vector<std::string> heading;  // comment lines
  std::vector<Table> tables;         // in the order of the file
};

// As TOML, to 12 digits; what is below 1e-12 is 0.
std::string toml_number(double value);
std::string toml_vector(const Eigen::Vector3d& value);
std::string toml_text(std::string_view value);
// A text without what a TOML comment must not hold.
std::string comment_text(std::string_view text);

// Sets what "drive.max_force_n=300" says. "wheel.width_m" is of all tables [[wheel]], "wheel.2.width_m" of the second.
// Throws DescriptionError if the file has no such key, or the value is not one value of TOML.
void set_value(Draft& draft, std::string_view assignment);

std::string toml_of(const Draft& draft);

// "drive.max_force_n = 300.0   friction gives way first": each key that was chosen, those of several tables once.
std::vector<std::string> chosen_keys(const Draft& draft);

}  // namespace kenaf::describe
