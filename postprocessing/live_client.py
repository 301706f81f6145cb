# SPDX-License-Identifier: BSD-3-Clause
"""Watches a run through Catalyst Live from a terminal: prints each step that arrives, its points and its arrays.

    postprocessing/pvpython_headless postprocessing/live_client.py [HOST:PORT] [--source NAME] [--steps N] [--wait SECONDS]

Start it first, then the run with --set 'insitu.live="localhost:22222"'. It listens as ParaView does after
Catalyst > Connect, and ends after N steps, or when nothing has arrived for SECONDS; status 1 if nothing ever did.
"""

import argparse
import sys
import time

from paraview import live


def parsed_arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("address", nargs="?", default="localhost:22222", metavar="HOST:PORT")
    parser.add_argument("--source", default="particles", help="what to receive: particles or network")
    parser.add_argument("--steps", type=int, default=1, metavar="N")
    parser.add_argument("--wait", type=float, default=60, metavar="SECONDS")
    return parser.parse_args()


def offered(link):
    """Names of what the run has."""
    proxies = link.GetInsituProxyManager()
    return [proxies.GetProxyName("sources", i) for i in range(proxies.GetNumberOfProxies("sources"))]


def main():
    arguments = parsed_arguments()
    host, port = arguments.address.rsplit(":", 1)
    link = live.ConnectToCatalyst(host, int(port))
    source, seen, last, patience = None, 0, None, time.monotonic() + arguments.wait
    while seen < arguments.steps and time.monotonic() < patience:
        live.ProcessServerNotifications()
        if source is None:
            if arguments.source in offered(link):
                source = live.ExtractCatalystData(link, arguments.source)
            time.sleep(0.02)
            continue
        source.UpdatePipeline()
        step, points = link.GetTimeStep(), source.GetDataInformation().GetNumberOfPoints()
        if points > 0 and step != last:
            print(f"step {step}: {points} points with {', '.join(sorted(source.PointData.keys()))}", flush=True)
            seen, last, patience = seen + 1, step, time.monotonic() + arguments.wait
    if not seen:
        sys.exit(f"error: no {arguments.source} arrived within {arguments.wait:g} s")


if __name__ == "__main__":
    main()
