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

}  // namespace
}  // namespace lichtveld::stream
