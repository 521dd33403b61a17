"""Splashes by remote control: every UDP datagram with two numbers, x and z in metres, is a splash there.

    python remote_splash.py http://localhost:8080 --port 9000
    echo "1.5 -2" > /dev/udp/127.0.0.1/9000
"""
import argparse
import asyncio

from spindrift import ConnectionLost, Rejected, aio


class Trigger(asyncio.DatagramProtocol):
    """Puts positions into a queue; when it is full, the newest is left out."""

    def __init__(self, queue):
        self._queue = queue

    def datagram_received(self, data, addr):
        try:
            x_m, z_m = (float(word) for word in data.decode().split())
            self._queue.put_nowait((x_m, z_m))
        except (ValueError, asyncio.QueueFull) as error:
            print(f"{addr[0]}: {data[:40]!r}: {error or 'too many triggers'}", flush=True)


async def run(url, port, count):
    queue = asyncio.Queue(maxsize=16)
    transport, _ = await asyncio.get_running_loop().create_datagram_endpoint(lambda: Trigger(queue), local_addr=("127.0.0.1", port))
    try:
        async with aio.connect(url, name="trigger") as water:
            print(f"waiting for triggers at port {transport.get_extra_info('sockname')[1]}", flush=True)
            while count != 0:
                x_m, z_m = await queue.get()
                try:
                    ack = await water.splash(x_m=x_m, z_m=z_m)
                    print(f"splash at {x_m:g}, {z_m:g} m in tick {ack.applied_tick}", flush=True)
                except (Rejected, ConnectionLost) as error:
                    print(f"no splash: {error}", flush=True)
                count -= 1
    finally:
        transport.close()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("url", nargs="?", default="http://localhost:8080")
    parser.add_argument("--port", type=int, default=9000, help="of UDP; 0: any free one")
    parser.add_argument("--count", type=int, default=-1, help="end after so many; -1: never")
    arguments = parser.parse_args()
    asyncio.run(run(arguments.url, arguments.port, arguments.count))


if __name__ == "__main__":
    main()
