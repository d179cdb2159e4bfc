#include "lichtveld/commands/commands.hpp"

int main(int argc, char** argv) {
  return lichtveld::commands::run(argc, argv);
}
