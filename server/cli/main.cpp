// spindrift: the program.
#include "commands.h"

int main(int argc, char** argv) {
  using namespace spindrift::cli;
  const auto add = [](CLI::App& program) {
    program.require_subcommand(1);
    std::vector<ProgramCommand> commands;
    for (const auto add_command : {addServe, addEdge, addReplay, addRecord, addScript, addInfo, addCheck}) {
      commands.push_back(add_command(program));
    }
    return commands;
  };
  return runProgram("spindrift",
                    "Spindrift: a headless water server. It simulates coupled particles and waves on a GPU and streams "
                    "them to browsers.",
                    add, argc, argv);
}
