// The word that was probably meant. Distances are counted by hand beside the words.
#include "formats/settings/nearest_word.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

using kenaf::settings::did_you_mean;
using kenaf::settings::either_of;
using kenaf::settings::nearest_word;
using kenaf::settings::shown;

using Words = std::vector<std::string>;

TEST_CASE("A character too many, missing, wrong or exchanged with its neighbour is one difference") {
  const Words options{"--speed", "--port"};
  for (const char* word : {"--sspeed", "--sped", "--spead", "--psede", "--speed=", "-speed", "--Speed"}) {
    CAPTURE(word);
    CHECK(nearest_word(word, options) == "--speed");
  }
}

TEST_CASE("A third of the characters may differ, and one of a word of three to five") {
  const Words words{"kitten"};
  CHECK(nearest_word("sitten", words) == "kitten");   // 6 characters: 2; k/s
  CHECK(nearest_word("sitting", words).empty());      // 7: 2; k/s, e/i and g are 3
  CHECK(nearest_word("mittens", words) == "kitten");  // 7: 2; k/m and s
  CHECK(nearest_word("raw", Words{"row"}) == "row");  // 3: 1
  CHECK(nearest_word("off", Words{"on"}).empty());    // 2 differences
  CHECK(nearest_word("x", Words{"y", "z"}).empty());  // as good as any
  CHECK(nearest_word("no", Words{"on"}).empty());     // 2 characters: none
  CHECK(nearest_word("teh", Words{"the"}) == "the");  // exchanged
  CHECK(nearest_word("", Words{"on", "off"}).empty());
}

TEST_CASE("The nearest counts, and of equals the first") {
  CHECK(nearest_word("step-3300", Words{"step-200", "step-300", "trench-300"}) == "step-300");  // 2, 1 and 5
  CHECK(nearest_word("cat", Words{"bat", "hat"}) == "bat");
}

TEST_CASE("The beginning of one word alone stands for it, however much is missing") {
  CHECK(nearest_word("sim", Words{"simulate", "score"}) == "simulate");
  CHECK(nearest_word("s", Words{"simulate"}).empty());
  CHECK(nearest_word("--camera", Words{"--camera-port", "--camera-image"}).empty());  // two begin so; 5 and 6 apart
}

TEST_CASE("Capitals, and underscores for hyphens, make no difference") {
  CHECK(nearest_word("--PORT_FILE", Words{"--port", "--port-file"}) == "--port-file");
  CHECK(nearest_word("Real", Words{"real", "sim"}) == "real");
}

TEST_CASE("No word is offered for itself, and none for what is no word") {
  CHECK(nearest_word("real", Words{"real", "reel"}).empty());
  CHECK(nearest_word(std::string(1 << 20, 'a'), Words{"aaa"}).empty());
  CHECK(did_you_mean("reel", Words{"real"}) == "; did you mean real?");
  CHECK(did_you_mean("xyzzy", Words{"real"}).empty());
}

TEST_CASE("Words are joined as in a sentence") {
  CHECK(either_of(Words{}).empty());
  CHECK(either_of(Words{"on"}) == "on");
  CHECK(either_of(Words{"on", "off"}) == "on or off");
  CHECK(either_of(Words{"m", "cm", "mm"}) == "m, cm or mm");
}

TEST_CASE("A value is shown so that its ends are seen, on one line") {
  CHECK(shown("-0.5") == "-0.5");
  CHECK(shown("[::1]:80") == "[::1]:80");
  CHECK(shown("") == "''");
  CHECK(shown(" 1") == "' 1'");
  CHECK(shown("a\nb") == "'a\\x0ab'");
  CHECK(shown(std::string(100, 'a')) == std::string(60, 'a') + "...");
}
