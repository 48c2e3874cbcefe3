#include <random>

#include "tests/server/world_server/conversation.hpp"
#include "tests/server/world_server/whole_log.hpp"

namespace kenaf::world_server {

namespace {

std::string box(int number, double x_m, const std::string& more = "") {
  return "CONTROL {Type Create} {ClassName Box} {Name Box" + std::to_string(number) + "} {Location " +
         std::to_string(x_m) + ",0,-1} " + more + "\r\n";
}

const std::string kLoose = "{Physics RigidBody}";

bool succeeds(Conversation& talk, const std::string& request) {
  return talk.answer_to(request).find("{Status OK}") != std::string::npos;
}

}  // namespace

TEST_CASE("Lines that are no messages are survived, and a client of nothing but them is let go", "[hostile]") {
  Conversation talk;
  talk.send("INIT {ClassName USARBot.P2DX}\r\n");
  for (const char* line : {"{", "}", "{}{}{}", "DRIVE {Left 1", "DRIVE }Left 1{", "GET / HTTP/1.1", "\x01\xff\xfe",
                           "{Left 1}", "DRIVE {Left {Right 1}}", "XYZZY {Plugh 1}", "DRIVE {Left 1} stray"}) {
    talk.send(std::string(line) + "\r\n");
    CHECK_FALSE(talk.session->close);
  }
  CHECK(talk.session->bad_lines > 5);
  talk.send("DRIVE {Left 1} {Right 1}\r\n");
  CHECK(talk.command().track_speed_mps[robot::kLeft] > 0);
  for (int i = 0; i < 1100; ++i) talk.send("{\r\n");
  CHECK(talk.session->close);
}

TEST_CASE("A web page's request, TLS and SSH are closed with one line in the log, and nothing in them is obeyed",
          "[hostile]") {
  for (const std::string opening : {"POST / HTTP/1.1\r\nHost: localhost:3000\r\n\r\n", "\r\nGET /x HTTP/1.1\r\n",
                                    "BREW /pot HTTP/1.1\r\n", "\x16\x03\x01\x02", "SSH-2.0-OpenSSH_9.2\r\n"}) {
    for (const std::size_t piece : {std::size_t{1}, opening.size()}) {  // however it is cut
      Conversation talk;
      const WholeLog log;
      for (std::size_t i = 0; i < opening.size(); i += piece) talk.send(opening.substr(i, piece));
      talk.send("INIT {ClassName USARBot.P2DX}\r\nDRIVE {Left 1} {Right 1}\r\n");
      CHECK(talk.session->close);
      CHECK_FALSE(talk.session->robot);
      CHECK(log.lines() == 1);
    }
  }
}

TEST_CASE("A thousand commands before INIT are one line in the log", "[hostile]") {
  const auto lines_logged = [](bool udk, std::string_view line) {
    Conversation talk(fast(udk));
    const WholeLog log;
    for (int i = 0; i < 1000; ++i) talk.send(std::string(line) + "\r\n");
    return log.lines();
  };
  for (const bool udk : {false, true}) {
    CHECK(lines_logged(udk, "DRIVE {Left 1} {Right 1}") == 1);
    CHECK(lines_logged(udk, "MULTIDRIVE {FRFlipper 1}") == 1);
    CHECK(lines_logged(udk, "MISPKG {Name C} {Link 1} {Value 1}") == 1);
  }
  const std::string set = "SET {Type Joint} {Name FRFlipper} {Opcode Angle} {Params 1}";
  CHECK(lines_logged(true, set) == 1);
  CHECK(lines_logged(false, set) == 1);
}

TEST_CASE("A line without end is dropped, bounded in memory, and what follows it is understood", "[hostile]") {
  Conversation talk;
  talk.send("INIT {ClassName USARBot.P2DX}\r\n");
  const std::string much(100000, 'x');
  for (int i = 0; i < 50; ++i) talk.send(much);
  talk.send("\r\nDRIVE {Left 1} {Right 1}\r\n");
  CHECK(talk.command().track_speed_mps[robot::kLeft] > 0);
  CHECK(talk.session->bad_lines == 1);
}

TEST_CASE("Commands for one frame are bounded", "[hostile]") {
  Conversation talk;
  talk.send("INIT {ClassName USARBot.P2DX}\r\nCONTROL {Type Session} {Period 1}\r\n");
  REQUIRE(talk.run(0.001));
  for (int i = 0; i < 10000; ++i) talk.send("DRIVE {Left 1} {Right 1} {Frame 1}\r\n");
  CHECK(talk.session->deferred.size() <= 65536);
}

TEST_CASE("One packet of many requests is answered until too much waits, then its client is let go", "[hostile]") {
  Conversation talk;
  for (int i = 0; i < 1000; ++i) talk.send(box(i, 2.0 * i));
  REQUIRE(talk.simulation.objects.size() == 1000);
  std::string packet;
  for (int i = 0; i < 780; ++i) packet += "CONTROL{Type GetSTA}\n";
  REQUIRE(packet.size() <= 16384);  // what a connection reads at once
  // An answer of 1000 objects is some 100 KB or more, so all of them would be 80 MB.
  talk.session->out.clear();
  talk.send(packet);
  CHECK(talk.session->close);
  CHECK(talk.session->out.size() > 8 << 20);
  CHECK(talk.session->out.size() < 9 << 20);
  talk.send(packet);  // what is still on its way is not obeyed
  CHECK(talk.session->out.size() < 9 << 20);
}

TEST_CASE("Of a thousand boxes for one place 33 are made, also if they come by a move, or would at a reset",
          "[hostile]") {
  for (const std::string& physics : {kLoose, std::string()}) {
    Conversation talk;
    talk.send("CONTROL {Type Session}\r\n");  // for the reasons
    int made = 0;
    for (int i = 0; i < 1000; ++i) made += succeeds(talk, box(i, 0, physics)) ? 1 : 0;
    CHECK(made == 33);  // the last of them overlaps 32 others
    CHECK(talk.simulation.objects.size() == 33);
    CHECK(talk.answer_to(box(1000, 0, physics)).find("32 objects") != std::string::npos);

    // Made elsewhere and moved there.
    REQUIRE(succeeds(talk, box(1001, 50, physics)));
    CHECK_FALSE(succeeds(talk, "CONTROL {Type AbsMove} {Name Box1001} {Location 0,0,-1}\r\n"));
    CHECK_FALSE(succeeds(talk, "CONTROL {Type RelMove} {Name Box1001} {Location -50,0,0}\r\n"));

    // Made there and moved away: a reset brings them back.
    for (int i = 0; i < 33; ++i) {
      const std::string x = std::to_string(100 + 3 * i);
      REQUIRE(
          succeeds(talk, "CONTROL {Type AbsMove} {Name Box" + std::to_string(i) + "} {Location " + x + ",0,-1}\r\n"));
    }
    CHECK_FALSE(succeeds(talk, box(1002, 0, physics)));
    CHECK(succeeds(talk, "CONTROL {Type Reset}\r\n"));
    // 33 boxes at one place are 33 * 32 / 2 = 528 pairs; each of 34 may be near the ground.
    CHECK(talk.simulation.world.pair_count() <= 528 + 34);
  }
}

TEST_CASE("Boxes that only touch do not overlap, and a floor counts as one", "[hostile]") {
  Conversation talk;
  REQUIRE(
      succeeds(talk, "CONTROL {Type Create} {ClassName Box} {Name Floor} {Location 0,0,-0.1} {Scale 100,100,0.2}\r\n"));
  for (int i = 0; i < 50; ++i) CHECK(succeeds(talk, box(i, i, kLoose)));  // a row of cubes of a metre, face to face
}

TEST_CASE("A box that may move has at most 20 m, a fixed one a kilometre", "[hostile]") {
  Conversation talk;
  CHECK(succeeds(talk, box(1, 0, kLoose + " {Scale 20,1,1}")));
  CHECK_FALSE(succeeds(talk, box(2, 0, kLoose + " {Scale 20.1,1,1}")));
  CHECK(succeeds(talk, box(3, 0, "{Scale 1000,1,1}")));
}

TEST_CASE("Requests that cost much wait for their client's next turn, in their order, and others do not wait",
          "[hostile]") {
  Conversation talk;
  Session& other = talk.simulation.connect("other");
  std::string packet = "CONTROL {Type Pause}\r\n";
  for (int i = 0; i < 700; ++i) packet += "CONTROL{Type Reset}\n";
  packet += "PING {Id 7}\r\n";
  REQUIRE(packet.size() <= 16384);  // what a connection reads at once

  // A turn each, and between them the other client has its own.
  int turns = 0;
  for (bool more = talk.simulation.receive(*talk.session, packet, talk.wall_s); more; ++turns) {
    CHECK_FALSE(talk.simulation.receive(other, "PING {Id 8}\r\n", talk.wall_s));
    more = talk.simulation.receive(*talk.session, {}, talk.wall_s);
  }
  CHECK(turns == 699);
  CHECK(Conversation::lines(other).size() == 1 + 699);  // NFO, and its answers
  const std::vector<std::string> answers = talk.lines("RES");
  CHECK(answers.size() == 701);
}

TEST_CASE("A name from outside cannot break an answer's grammar, nor fill it", "[hostile]") {
  Conversation talk;
  const std::string answer = talk.answer_to("SET {Type \x01\x02} {Name " + std::string(5000, 'n') + "}\r\n");
  CHECK(answer.size() < 300);
  CHECK(answer.find('\x01') == std::string::npos);
}

TEST_CASE("Random verbs with random values neither stop the world nor make it anything but finite", "[hostile]") {
  std::mt19937 random(5);
  const auto pick = [&](std::initializer_list<const char*> words) { return words.begin()[random() % words.size()]; };
  Conversation talk;
  talk.send("INIT {ClassName USARBot.Kenaf}\r\n");
  for (int i = 0; i < 3000; ++i) {
    std::string line = pick({"DRIVE", "MULTIDRIVE", "SET", "MISPKG", "CONTROL", "GETGEO", "GETCONF", "PING", "INIT"});
    const int groups = static_cast<int>(random() % 6);
    for (int g = 0; g < groups; ++g) {
      line += std::string(" {") + pick({"Left",       "Right",  "Type",      "Name",      "Value",    "Order", "Link",
                                        "Opcode",     "Params", "FRFlipper", "Location",  "Rotation", "Frame", "Speed",
                                        "Normalized", "Flip",   "Scale",     "ClassName", "Time",     "Period"}) +
              " " + pick({"1e308",         "-1e308", "0",   "-0.5", "1,2,3",   "Joint",      "FRFlipper",
                          "AbsMove",       "Create", "Box", "R1",   "Session", "Angle",      "True",
                          "CameraPanTilt", "1e-300", "0.5", "nan",  "Robot1",  "1e5,1e5,1e5"}) +
              "}";
    }
    talk.send(line + "\r\n");
    talk.simulation.advance(talk.wall_s);
    talk.wall_s += 0.001;
    talk.session->out.clear();
  }
  CHECK(talk.truth().X_WB.p.allFinite());
  CHECK(talk.truth().X_WB.q.coeffs().allFinite());
}

}  // namespace kenaf::world_server
