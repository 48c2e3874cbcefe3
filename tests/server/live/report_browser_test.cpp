// A person at the report of a diagnosis, a file in a real browser: from where the gap is to its moment, which plays,
// and through the table of look-alikes by the keyboard; on paper all of it. The pictures are kept beside the test's
// program, in live-view/.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "formats/runs/whole_file.hpp"
#include "gap/diagnose/page/sections.hpp"
#include "physics/world_description.hpp"
#include "tests/formats/runs/temporary_folder.hpp"
#include "tests/gap/diagnose/drawn_diagnosis.hpp"
#include "tests/server/live/browser.hpp"

namespace kenaf::live {

namespace {

struct ReportDesk {
  test::TemporaryFolder folder, profile;
  Browser browser;
  std::filesystem::path pictures = std::filesystem::path(KENAF_BIN_DIR) / ".." / "live-view";

  explicit ReportDesk(const std::vector<std::string>& switches = {}) : browser(profile.path(), switches) {
    gap::diagnose::Diagnosis d = test::drawn_diagnosis();
    std::vector<std::string> notes;
    d.observations.worlds.push_back(physics::load_world("step-200", notes));
    runs::write_whole_file(folder / "report.html",
                           gap::diagnose::diagnosis_page(d, test::drawn_overlays(d), "diagnosis"));
    std::filesystem::create_directories(pictures);
    browser.resize(1280, 900);
    browser.open("file://" + (folder / "report.html").string());
    browser.wait_for("document.readyState === 'complete'");
  }
  std::string text(const std::string& selector) {
    return browser.evaluate("document.querySelector('" + selector + "').textContent").get<std::string>();
  }
  void press(std::string_view code) {
    browser.key(code, true);
    browser.key(code, false);
  }
};

void load_page_checks(Browser& browser) {
  std::ifstream file(KENAF_PAGE_CHECKS);
  browser.evaluate(std::string(std::istreambuf_iterator<char>(file), {}) + ", 0");
}

}  // namespace

TEST_CASE("In a browser: a report leads from where the gap is to its moment, which plays") {
  ReportDesk desk;
  Browser& browser = desk.browser;
  // a phase in the table, and the same in the strips of time
  CHECK(browser.evaluate("document.querySelectorAll('svg a[href=\"#moment-1\"]').length > 0") == true);
  browser.evaluate("[...document.querySelectorAll('td a')].find((a) => a.textContent === 'climb').click()");
  browser.wait_for("location.hash === '#moment-1'");
  browser.wait_for("Math.abs(document.querySelector('#moment-1').getBoundingClientRect().top) < innerHeight");

  // a still picture at first; the real robot is at the moment that the heading names
  CHECK(desk.text("#moment-1 figcaption").starts_with("up & <over>, climb, at 1.38 s"));
  CHECK(desk.text("#moment-1 output") == "1.36 s");
  CHECK(browser.evaluate("document.querySelector('#moment-1 canvas').hidden") == true);

  // it plays to its end, and again from its start
  browser.evaluate("document.querySelector('#moment-1 button').click()");
  browser.wait_for("document.querySelector('#moment-1 canvas').dataset.drawn === '2.00'");
  browser.wait_for("document.querySelector('#moment-1 button').textContent === 'Play'");
  CHECK(browser.evaluate("document.querySelector('#moment-1 .still').checkVisibility()") == false);
  // time by the slider; something is drawn on the canvas, and another thing once it is turned
  browser.evaluate(
      "window.seen = () => { const c = document.querySelector('#moment-1 canvas'); return c.toDataURL().length > 3000 "
      "? "
      "c.toDataURL() : ''; }, document.querySelector('#moment-1 input[type=range]').value = '34', "
      "document.querySelector('#moment-1 input[type=range]').dispatchEvent(new Event('input'))");
  CHECK(desk.text("#moment-1 output") == "1.36 s");
  browser.evaluate("window.first = seen(), document.querySelector('#moment-1 canvas').focus()");
  CHECK(browser.evaluate("window.first.length > 0") == true);
  browser.screenshot(desk.pictures / "report-moment.png");
  desk.press("ArrowLeft");
  CHECK(browser.evaluate("seen() !== window.first") == true);
  // without the nominal robot there is less to see
  browser.evaluate("window.turned = seen(), document.querySelector('#moment-1 input[type=checkbox]').click()");
  CHECK(browser.evaluate("seen() !== window.turned") == true);
  for (const std::string& complaint : browser.complaints()) UNSCOPED_INFO(complaint);
  CHECK(browser.complaints().empty());
}

TEST_CASE("In a browser without WebGL the moments of a report stay still pictures, and the page says so") {
  ReportDesk desk({"--disable-3d-apis"});
  desk.browser.evaluate("document.querySelector('#moment-1 input[type=range]').dispatchEvent(new Event('input'))");
  CHECK(desk.browser.evaluate("document.querySelector('#moment-1 .still').checkVisibility()") == true);
  CHECK(desk.text("#moment-1 .controls").find("no WebGL") != std::string::npos);
}

TEST_CASE("In a browser: the table of look-alikes is read by the pointer and the keyboard, and is whole on paper") {
  ReportDesk desk;
  Browser& browser = desk.browser;
  const std::string rows =
      "[...document.querySelectorAll('.angles tbody tr')].filter((row) => row.checkVisibility()).length";
  CHECK(browser.evaluate(rows) == 1);
  CHECK(desk.text(".readout").starts_with("Point at a cell"));

  // one cell is reached by Tab; the arrow keys go on from there
  CHECK(browser.evaluate("document.querySelectorAll('.angles td[tabindex=\"0\"]').length") == 1);
  browser.evaluate("document.querySelector('.angles td[tabindex=\"0\"]').focus()");
  CHECK(desk.text(".readout") == "drive_lag: itself");
  desk.press("End");
  const std::string last = desk.text(".readout");
  CHECK((last == "drive_lag and com_forward: 80.0 degrees, different" ||
         last == "drive_lag and ground_slope: 75.0 degrees, different"));
  desk.press("ArrowDown");  // folded rows are none
  CHECK(desk.text(".readout") == last);
  browser.evaluate("document.querySelector('.angles input').click()");
  CHECK(browser.evaluate(rows) == 3);
  browser.evaluate("document.querySelector('.angles td[tabindex=\"0\"]').focus()");
  desk.press("ArrowDown");
  desk.press("ArrowDown");
  desk.press("ArrowLeft");
  CHECK(desk.text(".readout").find(": 4.2 degrees, alike: a small one may be taken for the other") !=
        std::string::npos);
  // the pointer has precedence while it is there
  browser.evaluate(
      "document.querySelector('.angles tbody td:nth-child(2)').dispatchEvent(new PointerEvent('pointerover', {bubbles: "
      "true}))");
  CHECK(desk.text(".readout") == "drive_lag: itself");

  // folded again: on paper all rows and still pictures, and nothing that would have to be pressed
  browser.evaluate("document.querySelector('.angles input').click()");
  CHECK(browser.evaluate(rows) == 1);
  browser.set_print(true);
  browser.wait_for("matchMedia('print').matches");
  CHECK(browser.evaluate(rows) == 3);
  CHECK(browser.evaluate("[...document.querySelectorAll('button, input, canvas, .readout')].every((e) => "
                         "!e.checkVisibility())") == true);
  CHECK(browser.evaluate("[...document.querySelectorAll('.still')].every((e) => e.checkVisibility())") == true);
  browser.set_print(false);
  CHECK(browser.complaints().empty());
}

TEST_CASE("In a browser: all text of a report has contrast, wide and narrow, light and dark") {
  ReportDesk desk;
  Browser& browser = desk.browser;
  load_page_checks(browser);
  browser.evaluate("document.querySelectorAll('.angles input').forEach((e) => e.click())");
  for (const auto& [width, height] : {std::pair{1280, 900}, {390, 844}}) {
    browser.resize(width, height, width < 500);
    browser.wait_for("innerWidth === " + std::to_string(width));
    for (const bool dark : {false, true}) {
      browser.set_dark(dark);
      browser.wait_for(std::string("matchMedia('(prefers-color-scheme: dark)').matches === ") +
                       (dark ? "true" : "false"));
      INFO(width << (dark ? ", dark" : ", light"));
      CHECK(browser.evaluate("pale()") == nlohmann::json::array());
      CHECK(browser.evaluate("nameless()") == nlohmann::json::array());
      CHECK(browser.evaluate("document.documentElement.scrollWidth <= innerWidth") == true);
      browser.evaluate("document.querySelector('#moments').scrollIntoView()");
      browser.screenshot(desk.pictures / ("report-" + std::to_string(width) + (dark ? "-dark.png" : "-light.png")));
    }
  }
}

}  // namespace kenaf::live
