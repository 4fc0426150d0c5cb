#include "command_line.hpp"

#include <CLI/CLI.hpp>

namespace mortise {

Parsed parse_command_line(int argc, const char* const* argv)
{
  CLI::App app("Mortise solves contact problems of linear elasticity by Total FETI.", "mortise");
  CommandLine result;
  bool version = false;
  app.add_option("DECK", result.deck, "YAML file that says what is solved");
  app.add_option("--set", result.settings, "laid over the deck; each setting takes its own --set")
      ->allow_extra_args(false)
      ->option_text("KEY.PATH=VALUE");
  app.add_option("--output", result.output, "directory for the results, instead of the deck's")->type_name("DIR");
  app.add_flag("--resume", result.resume, "go on where a run of the same deck was ended, after its last finished load state");
  app.add_flag("--check", result.check, "read deck and mesh, print what would be solved, and stop");
  app.add_flag("--allow-scripts", result.allow_scripts, "a .geo may start programs and write files: only for those you trust");
  app.add_flag("--schema", result.schema, "print the JSON schema of a deck and stop");
  app.add_flag("--version", version, "print the version and stop");
  app.footer(
      "Exit status: 0 solved, 1 command line, deck or mesh wrong, 2 not converged, 3 no equilibrium, 4 out of memory or disk, "
      "130 told to end.");
  try {
    app.parse(argc, const_cast<char**>(argv));
  } catch (const CLI::CallForHelp&) {
    return {{}, app.help(), 0};
  } catch (const CLI::ExtrasError& error) {
    const bool setting = std::string(error.what()).find('=') != std::string::npos && !result.settings.empty();
    const std::string cure = setting ? "Each setting takes its own --set: --set a=1 --set b=2.\n" : "";
    return {{}, std::string("mortise: ") + error.what() + "\n" + cure + "Try mortise --help.\n", 1};
  } catch (const CLI::ParseError& error) {
    return {{}, std::string("mortise: ") + error.what() + "\nTry mortise --help.\n", 1};
  }
  if (version) return {{}, "mortise " MORTISE_VERSION "\n", 0};
  if (result.deck.empty() && !result.schema) return {{}, "mortise: no deck is given\nTry mortise --help.\n", 1};
  return {result, {}, 0};
}

}  // namespace mortise
