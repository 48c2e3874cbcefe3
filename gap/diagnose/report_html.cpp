#include <fmt/format.h>

#include "gap/diagnose/report.hpp"
#include "gap/plot/chart.hpp"

namespace kenaf::gap {

std::string diagnosis_html(const Diagnosis& d) {
  return fmt::format("<!doctype html><meta charset=\"utf-8\"><title>Diagnosis</title><pre>{}</pre>\n",
                     plot::escaped(diagnosis_text(d)));
}

}  // namespace kenaf::gap
