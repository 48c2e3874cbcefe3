#include "relayd/mailbox.hpp"

#include <catch2/catch.hpp>
#include <memory>
#include <vector>

namespace kenaf::relayd {

TEST_CASE("A mailbox hands over what was put, oldest first, and refuses what does not fit") {
  int rung = 0;
  Mailbox<int, 2> mailbox([&] { ++rung; });
  CHECK(mailbox.put(1));
  CHECK(mailbox.put(2));
  CHECK_FALSE(mailbox.put(3));
  CHECK(rung == 3);  // what is full has to be emptied

  std::vector<int> taken;
  mailbox.take_all([&](int item) { taken.push_back(item); });
  CHECK(taken == std::vector<int>{1, 2});
}

TEST_CASE("A mailbox lets go of what it holds, taken or not: a connection in it is closed") {
  const auto taken = std::make_shared<int>(1);
  const auto left = std::make_shared<int>(2);
  {
    Mailbox<std::shared_ptr<int>, 4> mailbox([] {});
    mailbox.put(taken);
    mailbox.take_all([](const std::shared_ptr<int>&) {});
    mailbox.put(left);
    CHECK(taken.use_count() == 1);
    CHECK(left.use_count() == 2);
  }
  CHECK(left.use_count() == 1);
}

}  // namespace kenaf::relayd
