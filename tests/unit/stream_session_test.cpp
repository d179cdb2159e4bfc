#include <gmock/gmock.h>

#include <limits>

#include "lichtveld/stream/session.hpp"

namespace lichtveld::stream {
namespace {

// One metre a step, to the right only, as far as x = 2.
Place step_right(std::size_t cube, const std::vector<Place>& places, Move move) {
  Place place = places[cube];
  if (move == Move::right && place.x < 2) place.x += 1;
  return place;
}

Session two_cubes() {
  return Session({{0, 0}, {0, 5}}, step_right);
}

TEST(Session, CubesGoByOrderOfJoining) {
  Session session = two_cubes();
  for (const PeerNumber peer : {7, 3, 9, 1}) session.join(peer);
  EXPECT_EQ(session.role(7), (Role{1, 2, 2}));
  EXPECT_EQ(session.role(3), (Role{2, 2, 2}));
  EXPECT_EQ(session.role(9).cube, 0u);
  EXPECT_EQ(session.role(1).cube, 0u);
  EXPECT_EQ(session.role(1234).cube, 0u);
}

TEST(Session, LeaversCubeGoesToTheLongestWaiting) {
  Session session = two_cubes();
  for (const PeerNumber peer : {1, 2, 3, 4}) session.join(peer);
  session.move(1, Move::right);
  session.leave(1);
  EXPECT_EQ(session.role(3), (Role{1, 2, 1}));
  EXPECT_EQ(session.role(2).cube, 2u);
  EXPECT_EQ(session.places()[0], (Place{1, 0})) << "the cube stays where its player left it";
  session.leave(3);
  session.leave(2);
  EXPECT_EQ(session.role(4), (Role{1, 1, 0}));
  session.join(5);
  EXPECT_EQ(session.role(5), (Role{2, 2, 0}));
}

TEST(Session, WatchersAndStrangersLeaveNothing) {
  Session session = two_cubes();
  for (const PeerNumber peer : {1, 2, 3}) session.join(peer);
  session.leave(3);
  session.leave(3);
  session.leave(99);
  EXPECT_EQ(session.role(1), (Role{1, 2, 0}));
}

TEST(Session, JoiningTwiceTakesOneSeat) {
  Session session = two_cubes();
  session.join(1);
  session.join(1);
  session.join(2);
  EXPECT_EQ(session.role(2), (Role{2, 2, 0}));
}

TEST(Session, OnlyPlayersMoveAndOnlyTheirOwn) {
  Session session = two_cubes();
  for (const PeerNumber peer : {1, 2, 3}) session.join(peer);
  EXPECT_EQ(session.move(3, Move::right), MoveResult::watching);
  EXPECT_EQ(session.move(99, Move::right), MoveResult::watching);
  EXPECT_EQ(session.move(2, Move::right), MoveResult::moved);
  EXPECT_EQ(session.places(), (std::vector<Place>{{0, 0}, {1, 5}}));
  EXPECT_EQ(session.move(2, Move::up), MoveResult::blocked);
  EXPECT_EQ(session.move(2, Move::right), MoveResult::moved);
  EXPECT_EQ(session.move(2, Move::right), MoveResult::blocked);
  EXPECT_EQ(session.places()[1], (Place{2, 5}));
}

TEST(Session, FewerAndMoreCubesThanPlayers) {
  Session none({}, nullptr);
  none.join(1);
  EXPECT_EQ(none.role(1), (Role{0, 0, 1}));
  EXPECT_EQ(none.move(1, Move::up), MoveResult::watching);

  Session one({{0, 0}}, step_right);
  one.join(1);
  one.join(2);
  EXPECT_EQ(one.role(2), (Role{0, 1, 1}));

  Session three({{0, 0}, {1, 1}, {2, 2}}, step_right);
  for (const PeerNumber peer : {1, 2, 3}) three.join(peer);
  EXPECT_EQ(three.role(3), (Role{0, 2, 1})) << "the third cube is nobody's";
}

TEST(Session, NonsenseOfTheMoverMovesNothing) {
  Session session({{1, 2}}, [](std::size_t, const std::vector<Place>&, Move) {
    return Place{std::numeric_limits<float>::quiet_NaN(), 0};
  });
  session.join(1);
  EXPECT_EQ(session.move(1, Move::up), MoveResult::blocked);
  EXPECT_EQ(session.places()[0], (Place{1, 2}));
}

TEST(Session, BadBeginningsAreRefused) {
  EXPECT_THROW(Session({{0, 0}}, nullptr), std::invalid_argument);
  EXPECT_THROW(Session({{std::numeric_limits<float>::infinity(), 0}}, step_right), std::invalid_argument);
}

constexpr Session::TimePoint start{};
constexpr auto in_time = start + Session::claim_time, too_late = in_time + std::chrono::seconds(1);

TEST(Session, WhoComesBackInTimeGetsItsCubeFromItsHeir) {
  Session session = two_cubes();
  session.join(1, {.secret = "one"}, start);
  session.join(2, {.secret = "two"}, start);
  session.join(3, {.secret = "three"}, start);
  session.leave(1, start);
  EXPECT_EQ(session.role(3).cube, 1u);
  const auto joined = session.join(4, {.secret = "one again", .claim = "one"}, in_time);
  EXPECT_FALSE(joined.claim_refused);
  EXPECT_EQ(session.role(4), (Role{1, 2, 1}));
  EXPECT_EQ(session.role(3).cube, 0u) << "the heir watches again";
  session.leave(2, in_time);
  EXPECT_EQ(session.role(3).cube, 2u) << "and is the next in line, as before";
}

TEST(Session, ClaimsThatFitNothingAreRefused) {
  Session session = two_cubes();
  session.join(1, {.secret = "one"}, start);
  session.join(2, {.secret = "two"}, start);
  session.leave(1, start);
  session.join(3, {.secret = "three"}, start);
  EXPECT_TRUE(session.join(4, {.secret = "four", .claim = "somebody"}, start).claim_refused);
  EXPECT_TRUE(session.join(5, {.secret = "five", .claim = "one"}, too_late).claim_refused);
  EXPECT_EQ(session.role(3).cube, 1u);
  EXPECT_EQ(session.role(4).cube, 0u);
  EXPECT_EQ(session.role(5), (Role{0, 2, 2})) << "a newcomer like others";
}

TEST(Session, SecretIsUsedOnce) {
  Session session = two_cubes();
  session.join(1, {.secret = "one"}, start);
  session.join(2, {.secret = "two"}, start);
  session.leave(1, start);
  session.join(3, {.secret = "one again", .claim = "one"}, start);
  EXPECT_TRUE(session.join(4, {.secret = "four", .claim = "one"}, start).claim_refused);
  EXPECT_EQ(session.role(3).cube, 1u);
}

TEST(Session, ClaimOfAStayThatLastsTakesItsSeat) {
  Session session = two_cubes();
  for (const PeerNumber peer : {1, 2, 3, 4}) session.join(peer, {.secret = std::to_string(peer)}, start);
  const auto player = session.join(11, {.secret = "new one", .claim = "1"}, too_late);
  EXPECT_EQ(player.replaced, PeerNumber{1});
  EXPECT_EQ(session.role(11), (Role{1, 2, 2}));
  const auto watcher = session.join(13, {.secret = "new three", .claim = "3"}, too_late);
  EXPECT_EQ(watcher.replaced, PeerNumber{3});
  session.leave(1, too_late);  // has no seat any more
  session.leave(2, too_late);
  EXPECT_EQ(session.role(13).cube, 2u) << "a watcher keeps its place in the line";
}

// The one who had it first: who inherited it from that one has nothing to claim.
TEST(Session, OfTwoWhoComeBackForOneCubeTheFirstOwnerHasIt) {
  for (const bool owner_first : {true, false}) {
    Session session = two_cubes();
    for (const PeerNumber peer : {1, 2, 3, 4}) session.join(peer, {.secret = std::to_string(peer)}, start);
    session.leave(1, start);
    session.leave(3, start);  // the heir
    ASSERT_EQ(session.role(4).cube, 1u);
    const Entry owner{.secret = "a", .claim = "1"}, heir{.secret = "b", .claim = "3"};
    if (owner_first) session.join(11, owner, start);
    EXPECT_EQ(session.join(13, heir, start).claim_refused, owner_first);
    if (!owner_first) session.join(11, owner, start);
    EXPECT_EQ(session.role(11).cube, 1u);
    EXPECT_EQ(session.role(13).cube, 0u);
  }
}

TEST(Session, WatchersByTheirTicketNeverPlay) {
  Session session = two_cubes();
  session.join(1, {.may_play = false, .secret = "one"}, start);
  session.join(2, {.secret = "two"}, start);
  EXPECT_EQ(session.role(1).cube, 0u);
  EXPECT_EQ(session.role(2), (Role{1, 1, 1}));
  session.leave(2, start);
  EXPECT_EQ(session.role(1).cube, 0u);
  EXPECT_TRUE(session.join(3, {.may_play = false, .secret = "three", .claim = "two"}, start).claim_refused);
  EXPECT_EQ(session.role(3).cube, 0u);
}

}  // namespace
}  // namespace lichtveld::stream
