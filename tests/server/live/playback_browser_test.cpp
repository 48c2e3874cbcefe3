// A person at the playback page, in a real browser: a run plays, the time line is dragged, marks and figures are what
// the files say. The pictures are kept beside the test's program, in live-view/.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "formats/runs/whole_file.hpp"
#include "gap/datasets/simulate.hpp"
#include "gap/playback/playback_server.hpp"
#include "tests/formats/runs/temporary_folder.hpp"
#include "tests/server/live/browser.hpp"

namespace kenaf::live {

namespace {

using nlohmann::json;

// Two phases of one run; that of the other manoeuvre is not shown with it.
constexpr const char* kPlacesReport = R"({"format": "kenaf-gap-report/1", "verdict": "named", "named": ["drive_lag"],
  "where": {"channels": [{"channel": "track_left_mps", "share": 0.6, "floor": 0.002}],
            "phases": [{"manoeuvre": "straight", "run": "run-000.csv", "phase": "cruise", "from_s": 1, "to_s": 4, "share": 0.5},
                       {"manoeuvre": "straight", "run": "run-000.csv", "phase": "speed change", "from_s": 0.5, "to_s": 1, "share": 0.3},
                       {"manoeuvre": "turn-in-place", "run": "run-001.csv", "phase": "turn", "from_s": 1, "to_s": 4, "share": 0.2}]}})";

// The same with the stage whose gap it is, and the worst moment of each run.
constexpr const char* kReportOfWorst =
    R"({"format": "kenaf-gap-report/2", "verdict": "named", "named": ["drive_lag"], "stages": [],
  "where": {"stage": "body to sensor", "channels": [{"channel": "track_left_mps", "share": 0.6, "floor": 0.002}],
            "phases": [{"manoeuvre": "straight", "run": "run-000.csv", "phase": "cruise", "from_s": 1, "to_s": 4, "share": 0.5},
                       {"manoeuvre": "straight", "run": "run-000.csv", "phase": "speed change", "from_s": 0.5, "to_s": 1, "share": 0.3},
                       {"manoeuvre": "turn-in-place", "run": "run-001.csv", "phase": "turn", "from_s": 1, "to_s": 4, "share": 0.2}]},
  "runs": [{"run": "run-000.csv", "worst": {"at_s": 5.625, "times_noise": 7}},
           {"run": "run-001.csv", "worst": {"at_s": 1.375, "times_noise": 99}}]})";

struct PlaybackDesk {
  const char* report;
  test::TemporaryFolder folder, profile;
  gap::playback::PlaybackServer server{make(folder, report), {true, "127.0.0.1", 0, "sesame"}};
  Browser browser{profile.path()};
  std::filesystem::path pictures = std::filesystem::path(KENAF_BIN_DIR) / ".." / "live-view";

  static gap::playback::Playback make(const test::TemporaryFolder& folder, const char* report) {
    gap::datasets::SimulationRequest request;
    request.manoeuvres = {"straight", "turn-in-place"};
    request.effects = {"drive_lag:lag_s=0.5"};
    request.noise_scale = 0;
    request.out = folder / "runs";
    gap::datasets::simulate_dataset(request);
    std::filesystem::create_directory(folder / "report");
    runs::write_whole_file(folder / "report/report.json", report);
    const std::string robot = runs::read_whole_file(std::string(KENAF_SOURCE_DIR) + "/share/robots/kenaf.toml");
    runs::write_whole_file(folder / "report/robot.toml", robot + "\n[effects.drive_lag]\nlag_s = 0.5\n");
    return gap::playback::load_playback({folder / "runs", folder / "report", "", "", ""});
  }
  explicit PlaybackDesk(const char* with = kPlacesReport) : report(with) {
    std::filesystem::create_directories(pictures);
    browser.resize(1280, 800);
    browser.open(server.url());
    browser.wait_for("document.querySelectorAll('.mark').length");
  }
  void press(std::string_view code) {
    browser.key(code, true);
    browser.key(code, false);
  }
  double time_s() { return browser.evaluate("Number(document.getElementById('ruler').ariaValueNow)"); }
  double cursor_px() { return browser.evaluate("parseFloat(document.getElementById('cursor').style.left)"); }
  // Of the recorded robot, as the page says it.
  double x_m() {
    return browser.evaluate(
        "Number(document.getElementById('place').textContent.match(/x (.*?),/)[1].replace('\u2212', '-'))");
  }
  double difference(int row, int column) {
    return browser.evaluate("Number(document.querySelectorAll('#difference tbody tr')[" + std::to_string(row) +
                            "].cells[" + std::to_string(column) + "].textContent.replace('\u2212', '-'))");
  }
};

}  // namespace

TEST_CASE("In a browser: a recorded run plays beside its simulations, and the time line leads through it") {
  PlaybackDesk desk;
  Browser& browser = desk.browser;
  CHECK(browser.evaluate("document.querySelectorAll('.mark').length") == 2);  // of the report, for this run
  CHECK(browser.evaluate("document.querySelectorAll('.phase').length") > 2);
  CHECK(browser.evaluate("document.getElementById('verdict').textContent") == "named: drive_lag");
  CHECK(browser.evaluate("document.querySelectorAll('#legend input').length") == 4);  // three robots and their paths
  CHECK(browser.evaluate("document.getElementById('notes').children.length") == 0);
  browser.wait_for("document.getElementById('canvas').width > 300");

  // play moves the time and with it the robot; again, and it stands
  CHECK(desk.time_s() == 0);
  const double start_m = desk.x_m(), start_px = desk.cursor_px();
  browser.evaluate(
      "document.getElementById('pace').value = '5', document.getElementById('pace').dispatchEvent(new "
      "Event('change'))");
  desk.press("Space");
  browser.wait_for("Number(document.getElementById('ruler').ariaValueNow) > 2.5");
  desk.press("Space");
  const double stopped_s = desk.time_s();
  CHECK(desk.x_m() > start_m + 0.1);
  CHECK(desk.cursor_px() > start_px + 100);
  CHECK(browser.evaluate("document.getElementById('play').textContent") == "Play");

  // a sample back, on; the ends
  desk.press("ArrowRight");
  const double sample_s = desk.time_s();
  desk.press("ArrowRight");
  CHECK(desk.time_s() == Approx(sample_s + 0.01));
  desk.press("ArrowLeft");
  desk.press("ArrowLeft");
  CHECK(desk.time_s() == Approx(sample_s - 0.01));
  CHECK(std::abs(desk.time_s() - stopped_s) <= 0.016);
  desk.press("End");
  // both drive the same commands: the nominal one, quicker to start and to stop, ends as far; the corrected one is the
  // same
  CHECK(desk.time_s() == Approx(6));
  CHECK(std::abs(desk.difference(0, 2)) < 1);
  desk.press("Home");
  CHECK(desk.time_s() == 0);

  // the middle of the time line is dragged to
  browser.evaluate(
      "(() => { const r = document.getElementById('lanes').getBoundingClientRect(); const at = (type, x) => "
      "document.getElementById('lanes').dispatchEvent(new PointerEvent(type, {clientX: x, clientY: r.top + 5, "
      "pointerId: 1, "
      "bubbles: true})); document.getElementById('lanes').setPointerCapture = () => {}; at('pointerdown', r.left + "
      "100); "
      "at('pointermove', r.left + 58 + (r.width - 70) / 2); at('pointerup', r.left + 300); })()");
  CHECK(desk.time_s() == Approx(3).margin(0.02));
  // half a second of lag at 0.2 m/s or more: the nominal robot is ahead of the recorded one, and the corrected one with
  // it; measured minus simulated
  CHECK(desk.difference(1, 1) < -50);
  CHECK(std::abs(desk.difference(0, 2)) < 1);
  CHECK(browser.evaluate("document.getElementById('now-phase').textContent") == "cruise");
  // a mark says what it is to whoever comes to it by the keyboard
  browser.evaluate("document.querySelectorAll('.mark')[1].focus()");
  CHECK(browser.evaluate("document.getElementById('about-mark').textContent") ==
        "straight, cruise, 1.00 to 4.00 s: 50 % of the gap");
  browser.screenshot(desk.pictures / "playback.png");

  // another run has its own phases and marks
  browser.evaluate(
      "document.getElementById('run').value = '1', document.getElementById('run').dispatchEvent(new Event('change'))");
  browser.wait_for("document.querySelectorAll('.mark').length === 1");
  browser.set_dark(true);
  browser.resize(390, 844, true);
  browser.wait_for("innerWidth === 390");
  CHECK(browser.evaluate("document.documentElement.scrollWidth") <= 390);
  CHECK(browser.evaluate("[...document.querySelectorAll('button, select, input')].filter((e) => e.checkVisibility() && "
                         "!(e.textContent.trim() || e.ariaLabel || e.labels?.length)).length") == 0);
  browser.screenshot(desk.pictures / "playback-phone-dark.png");
  for (const std::string& complaint : browser.complaints()) UNSCOPED_INFO(complaint);
  CHECK(browser.complaints().empty());
}

TEST_CASE("In a browser: a playback shows the gap, where it is worst and how large it is there") {
  PlaybackDesk desk;
  Browser& browser = desk.browser;
  browser.wait_for("document.getElementById('canvas').width > 300");
  const auto text = [&](const std::string& id) {
    return browser.evaluate("document.getElementById('" + id + "').textContent").get<std::string>();
  };
  const auto shown = [&] {
    return browser.evaluate("[...document.querySelectorAll('.curve .title')].map((e) => e.textContent)");
  };

  // lag alone: x, travel and speed differ, of left and right one; y, z and the angles do not
  CHECK(shown().size() == 3);
  CHECK(browser.evaluate("document.querySelectorAll('.curve canvas').length") == 3);
  const std::string curves = shown().dump();
  CHECK_THAT(curves, Catch::Contains("x, m") && Catch::Contains("speed, m/s"));
  CHECK(browser.evaluate("document.querySelector('#channel-list label').textContent")
            .get<std::string>()
            .find("\u00d7 noise") != std::string::npos);

  // the button leads to the worst moment, and the words say how large it is: at both ends of the drive the lag is all
  const std::string worst = text("worst-words");
  CHECK_THAT(worst, Catch::StartsWith("Worst of this run at ") &&
                        Catch::Contains("\u00d7 noise off, rms of all channels; most in ") &&
                        Catch::Contains(": measured ") && Catch::Contains(", simulated ") &&
                        Catch::Contains(", difference "));
  desk.press("End");
  browser.evaluate("document.getElementById('worst').click()");
  CHECK(worst.find(
            "Worst of this run at " +
            browser.evaluate("Number(document.getElementById('ruler').ariaValueNow).toFixed(2)").get<std::string>() +
            " s") == 0);

  // the readings follow the cursor: at rest all are the same, at the worst moment the nominal one is off
  const auto readings = [&] {
    return browser.evaluate("document.querySelector('.readings').textContent").get<std::string>();
  };
  const std::string at_worst = readings();
  CHECK_THAT(at_worst, Catch::Contains("\u00d7 noise)"));
  desk.press("Home");
  CHECK(readings() != at_worst);

  // and the pointer, where there is one, until it leaves
  const std::string at_home = readings();
  browser.evaluate(
      "(() => { const lanes = document.getElementById('lanes'), left = lanes.getBoundingClientRect().left; "
      "lanes.dispatchEvent(new PointerEvent('pointermove', {clientX: left + 58 + (lanes.clientWidth - 70) / 4, "
      "pointerType: 'mouse', bubbles: true})); })()");
  CHECK(readings() != at_home);
  CHECK(browser.evaluate("document.getElementById('hover').dataset.time") == "1.50 s");
  CHECK(desk.time_s() == 0);
  browser.evaluate("document.getElementById('lanes').dispatchEvent(new PointerEvent('pointerleave'))");
  CHECK(readings() == at_home);

  // half of the time around the cursor, a quarter, and the whole run again
  browser.evaluate("document.getElementById('worst').click()");
  const auto ticks = [&] {
    return browser.evaluate("document.getElementById('ruler').textContent").get<std::string>();
  };
  const std::string whole = ticks();
  browser.evaluate("document.getElementById('zoom-in').click()");
  browser.evaluate("document.getElementById('zoom-in').click()");
  CHECK(ticks() != whole);
  CHECK(browser.evaluate("document.getElementById('cursor').hidden") == false);
  desk.press("Home");  // a cursor that leaves what is shown takes it along
  CHECK(desk.cursor_px() == 58);
  CHECK(ticks().starts_with("0 s"));
  browser.evaluate("document.getElementById('zoom-all').click()");
  CHECK(ticks() == whole);

  // ten times the deviation is said on the screen; the figures stay true
  browser.evaluate("document.getElementById('worst').click()");
  const double ahead_mm = desk.difference(1, 1);
  CHECK(browser.evaluate("document.getElementById('exaggerated').hidden") == true);
  browser.evaluate(
      "document.getElementById('exaggerate').value = '10', document.getElementById('exaggerate').dispatchEvent(new "
      "Event('input'))");
  CHECK(browser.evaluate("document.getElementById('exaggerated').hidden") == false);
  CHECK_THAT(text("exaggerated"), Catch::Contains("10 times as large"));
  CHECK(desk.difference(1, 1) == ahead_mm);
  // x of the nominal robot, 10 times as far from the recorded one
  CHECK(
      browser.evaluate(
          "import(new URL('playback_data.js', location.href).href).then(({exaggerated}) => { const at = (p, yaw, tip) "
          "=> ({p, q: "
          "[Math.cos(yaw / 2), 0, 0, Math.sin(yaw / 2)], flipper: [tip, 0, 0, 0]}); const far = exaggerated(at([1, 2, "
          "0], 0.1, 0.2), at([1.02, 2, 0.01], 0.2, 0.1), 10); return [...far.p, 2 * Math.atan2(far.q[3], far.q[0]), "
          "far.flipper[0]].map((v) => Number(v.toFixed(6))); })") == nlohmann::json{1.2, 2, 0.1, 1.1, -0.8});
  browser.screenshot(desk.pictures / "playback-exaggerated.png");

  // the curve of what is worst is among those that are shown, and its mean there is the one of the words
  const std::size_t most_in = worst.find("most in ") + 8, off = worst.find(", difference ") + 13;
  const std::string worst_title = worst.substr(most_in, worst.find(": measured", most_in) - most_in);
  CHECK_THAT(shown().dump(), Catch::Contains(worst_title));
  CHECK_THAT(text("curves"), Catch::Contains("mean " + worst.substr(off, worst.find(' ', off) - off) + ", "));

  // after a click Space plays, and presses the button no more
  browser.click("#worst");
  desk.press("Space");
  browser.wait_for("document.getElementById('play').textContent === 'Pause'");
  desk.press("Space");

  // the list of curves lies on the screen; Esc closes it, and a press beside it
  const auto list_is_open = [&] { return browser.evaluate("document.getElementById('channels').open") == true; };
  browser.click("#channels summary");
  browser.wait_for("document.getElementById('channel-list').style.maxHeight");
  CHECK(browser.evaluate(
            "(() => { const { top, bottom } = document.getElementById('channel-list').getBoundingClientRect();"
            " return top >= 0 && bottom <= innerHeight; })()") == true);
  desk.press("Escape");
  CHECK_FALSE(list_is_open());
  browser.click("#channels summary");
  CHECK(list_is_open());
  browser.click("h1");
  CHECK_FALSE(list_is_open());

  // the cursor goes through all curves, also those that one scrolls to; the list of runs tells where the gap is
  browser.evaluate("for (const box of document.querySelectorAll('#channel-list input:not(:checked)')) box.click()");
  CHECK(browser.evaluate("document.getElementById('cursor').getBoundingClientRect().bottom >= "
                         "document.getElementById('curves').getBoundingClientRect().bottom - 1") == true);
  CHECK_THAT(text("run"), Catch::Contains("80 % of the gap") && Catch::Contains("20 % of the gap"));

  // the picture has the 3D view above the words and the curves
  browser.evaluate(
      "window.saved = null, window.file = null, HTMLAnchorElement.prototype.click = function () { window.saved = "
      "this.download; }, URL.createObjectURL = (file) => { window.file = file; return '#'; }, "
      "document.getElementById('save').click()");
  browser.wait_for("window.saved !== null");
  CHECK_THAT(browser.evaluate("window.saved").get<std::string>(),
             Catch::StartsWith("run-000-") && Catch::EndsWith("s.png"));
  CHECK(browser.evaluate("window.file.type") == "image/png");
  CHECK(browser.evaluate("window.file.size > 20000") == true);
  // and the page says that it is saved
  CHECK_THAT(text("about-mark"),
             Catch::Contains("Picture saved as " + browser.evaluate("window.saved").get<std::string>()));
  CHECK(text("save") == "Picture saved");
  browser.wait_for("document.getElementById('save').textContent === 'Save picture'");
  for (const std::string& complaint : browser.complaints()) UNSCOPED_INFO(complaint);
  CHECK(browser.complaints().empty());
}

TEST_CASE(
    "In a browser: with a report's worst moments a playback opens on the worst run, and says whose moment is whose") {
  PlaybackDesk desk(kReportOfWorst);
  Browser& browser = desk.browser;
  const auto text = [&](const std::string& id) {
    return browser.evaluate("document.getElementById('" + id + "').textContent").get<std::string>();
  };
  // the second run, and its figure in the list beside the stage whose gap the share is of
  CHECK(browser.evaluate("document.getElementById('run').value") == "1");
  CHECK(text("worst") == "Worst moment of this run");
  CHECK_THAT(text("worst-words"), Catch::EndsWith("It is the worst of all runs."));
  CHECK_THAT(text("run"), Catch::Contains("worst 99 \u00d7 noise \u00b7 20 % of the gap from body to sensor") &&
                              Catch::Contains("worst 7.0 \u00d7 noise \u00b7 80 % of the gap from body to sensor"));
  CHECK_THAT(text("marks"), Catch::StartsWith("gap of sensors"));
  CHECK_THAT(text("about-mark"),
             Catch::Contains("a larger part of the gap from body to sensor: a sensor reports a motion that differs"));

  // the other run names the worst one
  browser.evaluate(
      "document.getElementById('run').value = '0', document.getElementById('run').dispatchEvent(new Event('change'))");
  browser.wait_for("document.querySelectorAll('.mark').length === 2");
  CHECK_THAT(text("worst-words"), Catch::EndsWith("Worst of all runs: 99 \u00d7 noise at 1.38 s of run-001.csv."));

  // every row of the table of differences is seen without scrolling
  CHECK(browser.evaluate("(() => { const box = document.getElementById('now').getBoundingClientRect(); return "
                         "[...document.querySelectorAll('#difference tr')].every((row) => "
                         "row.getBoundingClientRect().bottom <= box.bottom); })()") == true);

  // the figures of a curve are beside the cursor, and over it
  browser.evaluate("document.getElementById('worst').click()");
  browser.evaluate("document.getElementById('play').blur()");
  desk.press("Home");
  CHECK(browser.evaluate("[...document.querySelectorAll('.curve figcaption > span')].every((span) => "
                         "Number(getComputedStyle(span).zIndex) > "
                         "Number(getComputedStyle(document.getElementById('cursor')).zIndex))") == true);
  const std::string near =
      "(() => { const lanes = document.getElementById('lanes').getBoundingClientRect(), cursor = "
      "document.getElementById('cursor').getBoundingClientRect(); return "
      "[...document.querySelectorAll('.readings')].every((readings) => { const box = readings.getBoundingClientRect(), "
      "before = readings.previousElementSibling.getBoundingClientRect(); return box.right <= lanes.right && box.left > "
      "before.right && (box.left <= cursor.right + 14 || box.left <= before.right + 14) && box.right >= cursor.left - "
      "14; }); })()";
  CHECK(browser.evaluate(near) == true);
  for (int i = 0; i < 100; ++i) desk.press("ArrowRight");
  CHECK(browser.evaluate(near) == true);
  desk.press("End");
  CHECK(browser.evaluate(near) == true);
  browser.screenshot(desk.pictures / "playback-worst.png");
  CHECK(browser.complaints().empty());
}

}  // namespace kenaf::live
