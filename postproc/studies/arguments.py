"""The command line of a study."""

import argparse
import math
import pathlib

from studies.refinement import BadInput


def exact_value(text):
    path, equal, value = text.partition("=")
    try:
        number = float(value)
    except ValueError:
        number = math.nan
    if not equal or not math.isfinite(number):
        raise argparse.ArgumentTypeError(f"{text!r}; expected QUANTITY=VALUE, such as contacts.0.max_recovered_pressure=69.23")
    return path, number


def tolerance_value(text):
    try:
        if 0 < float(text) < 1:
            return text
    except ValueError:
        pass
    raise argparse.ArgumentTypeError(f"{text!r}; expected numbers between 0 and 1 (auto is always run)")


def at_least(least, kind=int):
    def check(text):
        try:
            if kind(text) >= least:
                return kind(text)
        except ValueError:
            pass
        raise argparse.ArgumentTypeError(f"{text!r}; expected a number of at least {least}")

    return check


def parse(words, description):
    parser = argparse.ArgumentParser(
        prog="mortise study", description=description, formatter_class=argparse.RawDescriptionHelpFormatter, usage=argparse.SUPPRESS
    )
    parser.error = lambda message: (_ for _ in ()).throw(BadInput(message))
    parser.add_argument("mortise", help=argparse.SUPPRESS)
    parser.add_argument("deck", type=pathlib.Path)
    parser.add_argument("--refine", type=at_least(0), default=2, metavar="N", help="finer meshes beside the deck's own; default 2")
    parser.add_argument("--factor", type=at_least(1.05, float), metavar="F", help="of cells along an edge from mesh to mesh")
    parser.add_argument("--size", nargs="+", default=[], metavar="NAME", help="constants of the .geo to divide")
    parser.add_argument("--count", nargs="+", default=[], metavar="NAME", help="constants of the .geo to multiply")
    parser.add_argument("--tolerances", nargs="+", type=tolerance_value, default=[], metavar="T", help="beside auto")
    parser.add_argument("--tolerance-mesh", type=at_least(0), metavar="K", help="only on mesh K (0: the deck's own)")
    parser.add_argument("--elements", nargs="+", default=[], metavar="E")
    parser.add_argument("--quantity", nargs="+", metavar="PATH")
    parser.add_argument("--exact", nargs="+", type=exact_value, default=[], metavar="QUANTITY=VALUE")
    parser.add_argument("--pressure", metavar="FORMULA")
    parser.add_argument("--contact", type=at_least(0), default=0, metavar="I", help="the contact that --pressure is of")
    parser.add_argument("--field", default="contact_pressure_recovered", choices=["contact_pressure_recovered", "contact_pressure"])
    parser.add_argument("--plot", metavar="QUANTITY", help="of the plots; default: the pressure, else the first of --exact, else the first")
    parser.add_argument("--ranks", type=at_least(1), default=1)
    parser.add_argument("--mpiexec", default="mpirun", help=argparse.SUPPRESS)
    parser.add_argument("--calculix", action="store_true", help="CalculiX (ccx) on the same meshes")
    parser.add_argument(
        "--solvers",
        nargs="+",
        default=["SPOOLES", "ITERATIVE CHOLESKY"],
        choices=["SPOOLES", "ITERATIVE CHOLESKY"],
        help="of CalculiX; default: both",
    )
    parser.add_argument(
        "--penalty", nargs="+", type=at_least(1e-3, float), default=[50.0], help="of CalculiX, in Young's moduli a length; default 50"
    )
    parser.add_argument("--time-limit", type=at_least(1, float), default=900.0, metavar="SECONDS", help="of one run; default 900")
    parser.add_argument("--repeat", type=at_least(1), default=1, metavar="N", help="runs of each, of which the cheapest counts")
    parser.add_argument(
        "--allow-scripts", action="store_true", help="a .geo may start programs and write files, and the command gmsh may mesh it: only for those you trust"
    )
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE")
    parser.add_argument("--output", type=pathlib.Path, metavar="DIR", help="default: <deck name>.study.out beside the deck")
    arguments = parser.parse_args(words)
    arguments.exact = dict(arguments.exact)
    if arguments.tolerance_mesh is not None and arguments.tolerance_mesh > arguments.refine:
        raise BadInput(f"--tolerance-mesh {arguments.tolerance_mesh}: the meshes are 0 to {arguments.refine} (--refine)")
    if arguments.contact and not arguments.pressure:
        raise BadInput("--contact says which contact --pressure is of; there is no --pressure")
    arguments.deck = arguments.deck.resolve()
    arguments.mortise = str(pathlib.Path(arguments.mortise).resolve())
    arguments.output = arguments.output or arguments.deck.with_name(arguments.deck.stem + ".study.out")
    return arguments
