# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The program glidar-campaign, which `glidar campaign` runs."""

import argparse
import re
import signal

from glidar import Error
from glidar._errors import excerpt
from glidar._printing import print_line, print_message
from glidar.campaign.progress import print_warnings

DONE, TRIALS_FAILED, BAD_INPUT, INTERRUPTED = 0, 1, 2, 130
CODES = ("Exit codes: 0 done, 1 done but trials failed or files differ, 2 bad input, "
         "130 interrupted; run the same command again to resume.")


class Parser(argparse.ArgumentParser):
    """Reports errors like glidar: one line, exit code 2."""

    def error(self, message):
        raise Error(self.prog, message, "", "see --help")


def _part(text):
    match = re.fullmatch(r"([0-9]{1,9})/([0-9]{1,9})", text)
    if not match or not int(match[1]) < int(match[2]):
        raise argparse.ArgumentTypeError(f"'{excerpt(text)}'; allowed: i/N with i from 0 to N - 1")
    return int(match[1]), int(match[2])


def _count(text):
    if not re.fullmatch("[0-9]{1,9}", text) or int(text) < 1:
        raise argparse.ArgumentTypeError(f"'{excerpt(text)}'; allowed: a whole number from 1 to 999999999")
    return int(text)


def _add_durable(command):
    command.add_argument("--durable", action=argparse.BooleanOptionalAction, default=True,
                         help="sync files to the disk before a receipt lists them, so that power loss does not "
                              "damage completed shards (default: on)")


def make_parser():
    parser = Parser(prog="glidar campaign", description="Monte Carlo campaigns", epilog=CODES,
                    allow_abbrev=False)
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND",
                                     parser_class=Parser)
    run = commands.add_parser("run", help="measure all missing trials",
                              epilog=CODES, allow_abbrev=False)
    run.add_argument("campaign", metavar="CAMPAIGN.yaml", help="the campaign file, see docs/campaigns.md")
    run.add_argument("-o", "--output", metavar="DIR", required=True, help="folder of the data set")
    run.add_argument("--workers", metavar="N", type=_count, default=0,
                     help="processes on this machine (default: 1; one per core when scenes or sensors differ "
                          "between trials)")
    run.add_argument("--shard", metavar="i/N", type=_part, default=(0, 1),
                     help="measure only part i of N, from 0; merge the parts later (default: 0/1)")
    run.add_argument("--executor", choices=["local", "dask", "slurm"], default="local",
                     help="where trials run: this machine, Dask workers, or a Slurm job array (default: local)")
    run.add_argument("--scheduler", metavar="ADDR", help="address of the Dask scheduler, e.g. tcp://127.0.0.1:8786")
    run.add_argument("--tasks", metavar="N", type=_count, default=None,
                     help="tasks of the Slurm job array (default: 8)")
    run.add_argument("--sbatch", metavar="OPTION", action="append", default=[],
                     help="an option for sbatch, e.g. --sbatch=--time=10:00; repeatable")
    run.add_argument("--wait", action="store_true", help="wait until Slurm has finished the campaign")
    _add_durable(run)
    run.add_argument("--quiet", action="store_true", help="no progress display")
    merge = commands.add_parser("merge", help="combine and finish a campaign that ran in parts", epilog=CODES,
                                allow_abbrev=False)
    merge.add_argument("parts", metavar="DIR", nargs="+", help="folders of the parts")
    merge.add_argument("-o", "--output", metavar="DIR", help="folder of the merged campaign (default: the first DIR)")
    _add_durable(merge)
    report = commands.add_parser("report", help="write report.html", epilog=CODES, allow_abbrev=False)
    report.add_argument("folder", metavar="DIR")
    report.add_argument("-o", "--output", metavar="FILE", help="the file to write (default: DIR/report.html)")
    check = commands.add_parser("check", help="compare every file with its hash in the manifest",
                                epilog=CODES, allow_abbrev=False)
    check.add_argument("folder", metavar="DIR")
    return parser


def _print_outcome(outcome, root):
    """Prints the last line; returns the exit code."""
    if outcome.missing:
        print_line(f"{root}: {outcome.missing} shards are missing; run the other parts, then merge")
        return BAD_INPUT
    rate = f", {outcome.rate:.4g} trials/s" if outcome.rate else ""
    kind = "" if outcome.whole else " of this part"
    print_line(f"{root}: {outcome.trials} trials{kind}, {outcome.failed} failed{rate}")
    if outcome.failed:
        print_message(f"glidar: warning: trials failed, {outcome.error}")
        if outcome.whole:
            print_message(f"glidar: warning: 'error' in index.parquet of all failed trials is listed there, and by glidar campaign report {root}")
    return TRIALS_FAILED if outcome.failed else DONE


def _executor(flags):
    """The function that runs the shards; None: this machine."""
    if flags.scheduler and flags.executor != "dask":
        raise Error("--scheduler", "given without --executor dask", "", "")
    if (flags.tasks or flags.sbatch or flags.wait) and flags.executor != "slurm":
        raise Error("--tasks, --sbatch, --wait", "given without --executor slurm", "", "")
    if flags.executor == "dask":
        from glidar.campaign.dask_executor import dask_executor

        return dask_executor(flags.scheduler)
    return None


def _run(flags):
    from glidar.campaign import run as running

    if flags.executor == "slurm":
        from glidar.campaign import slurm_executor

        outcome = slurm_executor.submit(flags)
        return DONE if outcome is None else _print_outcome(outcome, flags.output)
    outcome = running.run(flags.campaign, flags.output, running.ShardSubset(*flags.shard), flags.workers,
                          _executor(flags), flags.quiet, durable=flags.durable)
    return _print_outcome(outcome, flags.output)


def _merge(flags):
    from glidar.campaign import run as running

    root = flags.output or flags.parts[0]
    return _print_outcome(running.merge(flags.parts, root, flags.durable), root)


def _report(flags):
    from glidar.campaign import report

    print_line(f"wrote {report.write(flags.folder, flags.output)}")
    return DONE


def _check(flags):
    from glidar.campaign import run as running

    count, wrong = running.check(flags.folder)
    for name in wrong:
        print_line(f"{flags.folder}/{name}: missing or different from the manifest")
    print_line(f"{flags.folder}: {count - len(wrong)} of {count} files match the manifest")
    return TRIALS_FAILED if wrong else DONE


def _fail(text):
    print_message(f"glidar: error: {text}")
    return BAD_INPUT


def main(arguments=None):
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    print_warnings()
    try:
        flags = make_parser().parse_args(arguments)
        return {"run": _run, "merge": _merge, "report": _report, "check": _check}[flags.command](flags)
    except Error as error:
        return _fail(error)
    except ModuleNotFoundError as error:
        return _fail(f"Python package '{error.name}' is missing; install the dependencies of campaigns: "
                     "pip install '.[campaign]' in GLIDAR's source")
    except KeyboardInterrupt:
        print_message("")  # the line of the progress ends
        print_message("glidar: interrupted; run the same command again to resume")
        return INTERRUPTED
