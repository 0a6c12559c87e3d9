"""Fleets on a real S3 server on loopback, behind a proxy that fails some requests."""

import json

import pytest
from excavator import fleet

from . import cheap
from .failing_proxy import FailingProxy

pytestmark = pytest.mark.usefixtures("engine")
boto3 = pytest.importorskip("boto3")
moto = pytest.importorskip("moto.server")


@pytest.fixture
def server():
    """A server with the bucket `fleet`; yields its port and a client."""
    server = moto.ThreadedMotoServer(ip_address="127.0.0.1", port=0)
    server.start()
    host, port = server.get_host_and_port()
    client = boto3.client(
        "s3", endpoint_url=f"http://{host}:{port}", region_name="us-east-1", aws_access_key_id="x", aws_secret_access_key="x"
    )
    client.create_bucket(Bucket="fleet")
    yield port, client
    server.stop()


def options_of(endpoint):
    return {
        "endpoint": endpoint,
        "allow_http": "true",
        "region": "us-east-1",
        "access_key_id": "x",
        "secret_access_key": "x",
    }


def test_nothing_is_lost_and_nothing_is_done_twice(server, tmp_path):
    port, client = server
    log = tmp_path / "log"
    pairs = []
    for number in range(30):
        own = {"machine": f"machine {number % 5}", "model": "zx30u-arm", "recorded": "2026-01-01T00:00:00Z"}
        for role in ("identification", "validation"):
            client.put_object(Bucket="fleet", Key=f"bags/{number}-{role}.mcap", Body=f"{number}-{role}\n".encode())
            own[role] = f"s3://fleet/bags/{number}-{role}.mcap"
        pairs.append(own)
    proxy = FailingProxy(port)
    with proxy as endpoint:
        work = cheap.work_of(log, dies_once="7")
        report = fleet.run(pairs, "s3://fleet/results", store=options_of(endpoint), work=work)
        assert (len(report.done), report.failed, report.poisoned, report.left) == (30, {}, {}, 0)
        results = fleet.Results("s3://fleet/results", fleet.Store(options_of(endpoint)))
        keys = results.done()
        contents = sorted(json.loads(results.json(key))["content"] for key in keys)
        again = fleet.run(pairs, "s3://fleet/results", store=options_of(endpoint), work=work)
    assert contents == sorted(f"{n}-identification\n{n}-validation\n" for n in range(30))
    assert (again.skipped, again.starts) == (30, 0)
    assert proxy.failures >= 15
    starts = cheap.starts(log)
    assert starts.pop("7") == 2 and set(starts.values()) == {1}


def test_a_result_is_written_once_though_its_answer_is_lost(server):
    port, client = server
    with FailingProxy(port, every=2) as endpoint:
        store = fleet.Store(options_of(endpoint))
        for number in range(12):
            url = f"s3://fleet/once/{number}"
            assert store.put_if_absent(url, b"first")
            assert not store.put_if_absent(url, b"second")
            assert client.get_object(Bucket="fleet", Key=f"once/{number}")["Body"].read() == b"first"
