"""Reads volumes from lists of chunks, and from a bucket: a server on this machine in the layout of the public bucket."""

import contextlib
import datetime
import http.server
import importlib.util
import pathlib
import re
import threading
import unittest
import unittest.mock
import urllib.parse

import numpy as np

import stormcellar
from cellar import DATA
from stormcellar import sources

CHUNKS = pathlib.Path(DATA or "") / "chunks/KLOT_34"
STORM = pathlib.Path(DATA or "") / "volumes/KTLX19990503_235621.gz"


@unittest.skipUnless(DATA, "no real volumes: set STORMCELLAR_DATA")
class Chunks(unittest.TestCase):
    def test_chunks_are_one_volume_in_the_order_of_their_numbers(self):
        files = sorted(CHUNKS.iterdir())
        whole = stormcellar.Volume(b"".join(file.read_bytes() for file in files))
        with contextlib.ExitStack() as stack:
            lists = [files[::-1], [str(file) for file in files], [file.read_bytes() for file in files],
                     [stack.enter_context(open(file, "rb")) for file in files]]
            for chunks in lists:
                volume = stormcellar.Volume(chunks)
                self.assertEqual(repr(volume), repr(whole))
                np.testing.assert_array_equal(volume.sweeps[-1].moments["REF"].codes(),
                                              whole.sweeps[-1].moments["REF"].codes())

    def test_an_empty_list_is_empty(self):
        with self.assertRaises(stormcellar.Error) as caught:
            stormcellar.Volume([])
        self.assertEqual(caught.exception.code, "empty")


class Bucket(http.server.ThreadingHTTPServer):
    """Serves `objects` (bytes by key) with listings of two keys a page. Fails `failures` times before it answers."""

    def __init__(self, objects):
        super().__init__(("127.0.0.1", 0), Answers)
        self.objects, self.failures, self.asked = objects, 0, []
        self.address = f"http://127.0.0.1:{self.server_port}"

    def page(self, prefix, token):
        keys = [key for key in sorted(self.objects) if key.startswith(prefix) and key > token]
        listed = "".join(f"<Contents><Key>{key}</Key><Size>{len(self.objects[key])}</Size></Contents>" for key in keys[:2])
        more = f"<IsTruncated>true</IsTruncated><NextContinuationToken>{''.join(keys[1:2])}</NextContinuationToken>"
        return f'<ListBucketResult xmlns="http://s3.amazonaws.com/doc/2006-03-01/">{listed}' \
               f'{more if len(keys) > 2 else ""}</ListBucketResult>'.encode()


class Answers(http.server.BaseHTTPRequestHandler):
    def do_GET(self):
        path, _, query = self.path.partition("?")
        question = urllib.parse.parse_qs(query)
        self.server.asked.append(self.path)
        body = self.server.objects.get(path[1:])
        if query:
            body = self.server.page(question["prefix"][0], question.get("continuation-token", [""])[0])
        if self.server.failures > 0:
            self.server.failures -= 1
            self.send_error(503)
        elif body is None:
            self.send_error(404)
        else:
            self.send_response(200)
            self.send_header("Content-Length", str(len(body)))
            self.end_headers()
            self.wfile.write(body)

    def log_message(self, *arguments):
        pass


class Fetching(unittest.TestCase):
    objects = {
        "1999/05/03/KTLX/KTLX19990503_234610.gz": b"earlier",
        "1999/05/03/KTLX/KTLX19990503_235109.gz": b"before",
        "1999/05/03/KTLX/KTLX19990503_235621_MDM": b"metadata",
        "1999/05/03/KTLX/KTLX19990503_235621.gz": b"storm",
        "1999/05/03/KTLX/index.html": b"a page",
        "1999/05/04/KTLX/KTLX19990504_000118.gz": b"after midnight",
    }

    def setUp(self):
        self.bucket = Bucket(dict(self.objects))
        server = threading.Thread(target=self.bucket.serve_forever)
        server.start()
        self.addCleanup(lambda: (self.bucket.shutdown(), server.join(), self.bucket.server_close()))
        patched = unittest.mock.patch.object(sources, "_WAITS_S", (0, 0, 0))
        patched.start()
        self.addCleanup(patched.stop)

    def fetched(self, time, station="KTLX"):
        with self.assertLogs("stormcellar") as logged:
            data = sources.fetched(station, time, self.bucket.address)
        self.assertRegex(logged.output[0], f"fetching {re.escape(self.bucket.address)}/[0-9/]+/KTLX/KTLX")
        return data

    def test_the_last_volume_that_began_before_the_time(self):
        utc = datetime.timezone.utc
        east = datetime.timezone(datetime.timedelta(hours=-5))
        for time, right in (("1999-05-03T23:56:21", b"storm"), ("1999-05-03 23:56:20Z", b"before"),
                            ("1999-05-04T00:01", b"storm"), (np.datetime64("1999-05-04T00:31"), b"after midnight"),
                            (datetime.datetime(1999, 5, 3, 23, 50), b"earlier"),
                            (datetime.datetime(1999, 5, 3, 23, 58, tzinfo=utc), b"storm"),
                            (datetime.datetime(1999, 5, 3, 18, 58, tzinfo=east), b"storm")):
            self.assertEqual(self.fetched(time), right, time)
        self.assertEqual(self.fetched("1999-05-03T23:57", "ktlx"), b"storm")

    def test_errors_name_what_is_wrong(self):
        for time, station, text, code in (
                ("1999-05-04T00:40", "KTLX", "KTLX .* the nearest began at 1999-05-04T00:01:18Z", "not_found"),
                ("1999-05-03T12:00", "KTLX", "the nearest began at 1999-05-03T23:46:10Z", "not_found"),
                ("2001-01-01T12:00", "KTLX", "has none of that day", "not_found"),
                ("1999-05-03T23:57", "../etc", "is no station", "bad_argument")):
            with self.assertRaisesRegex(stormcellar.Error, text) as caught:
                sources.fetched(station, time, self.bucket.address)
            self.assertEqual(caught.exception.code, code)
        with self.assertRaisesRegex(stormcellar.Error, "file:///etc"):
            sources.fetched("KTLX", "1999-05-03", "file:///etc")

    def test_a_busy_bucket_is_asked_again(self):
        self.bucket.failures = 3
        self.assertEqual(self.fetched("1999-05-03T23:57"), b"storm")
        self.bucket.failures = 4
        with self.assertRaisesRegex(stormcellar.Error, "503") as caught:
            sources.fetched("KTLX", "1999-05-03T23:57", self.bucket.address)
        self.assertEqual(caught.exception.code, "io")

    def test_a_listing_without_an_end_is_an_error(self):
        with unittest.mock.patch.object(self.bucket, "page", lambda prefix, token: Bucket.page(self.bucket, prefix, "")):
            with self.assertRaisesRegex(stormcellar.Error, "does not end"):
                sources.fetched("KTLX", "1999-05-03T23:57", self.bucket.address)

    def test_an_answer_of_another_length_is_an_error(self):
        with unittest.mock.patch.object(sources, "_volumes_of_day", return_value=[
                (np.datetime64("1999-05-03T23:56:21"), "1999/05/03/KTLX/KTLX19990503_235621.gz", 9)]):
            with self.assertRaisesRegex(stormcellar.Error, "has 5 bytes, not 9"):
                self.fetched("1999-05-03T23:57")

    @unittest.skipUnless(DATA, "no real volumes: set STORMCELLAR_DATA")
    def test_a_station_and_a_time_are_a_volume(self):
        self.bucket.objects["1999/05/03/KTLX/KTLX19990503_235621.gz"] = STORM.read_bytes()
        options = {"time": "1999-05-03T23:57", "bucket": self.bucket.address}
        with self.assertLogs("stormcellar"):
            volume = stormcellar.Volume("ktlx", **options)
        self.assertEqual(repr(volume), repr(stormcellar.Volume(STORM)))
        if importlib.util.find_spec("xarray"):
            import xarray

            from stormcellar.backend import StormcellarBackendEntrypoint

            with self.assertLogs("stormcellar"):
                sweep = xarray.open_dataset("KTLX", engine=StormcellarBackendEntrypoint, **options)
            self.assertIn("DBZH", sweep)


if __name__ == "__main__":
    unittest.main()
