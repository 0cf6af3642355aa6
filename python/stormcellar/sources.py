"""Bytes of volumes: chunks of the real-time feed, and files of the public bucket.

Source of the layout of the bucket: docs/data-sources.md.
"""

from __future__ import annotations

import datetime
import http.client
import logging
import os
import re
import time as clock
import urllib.error
import urllib.parse
import urllib.request
from xml.etree import ElementTree

import numpy as np

from ._library import Error

BUCKET = "https://unidata-nexrad-level2.s3.amazonaws.com"

_log = logging.getLogger("stormcellar")
_CHUNK = re.compile(r"\d{8}-\d{6}-\d{3}-[SIE]")
_VOLUME = re.compile(r"[A-Z0-9]{4}(\d{8}_\d{6})(?!.*_MDM$)")  # names that end in _MDM have no radials
_LONGEST = np.timedelta64(30, "m")  # no volume takes longer
_MOST_BYTES = 512 << 20  # of a volume, or of a page of a listing
_MOST_PAGES = 100  # of a day, which has some 400 volumes
_WAITS_S = (0.5, 1, 2)  # between tries


def joined(chunks) -> bytes:
    """Returns the bytes of a list of paths, bytes or open files as one. Paths with names of chunks, such as
    20201019-054806-001-S, are read by their numbers, all others in the order of the list.

    >>> joined([b"AR2V", b"0006."])
    b'AR2V0006.'
    """
    chunks = list(chunks)
    if all(isinstance(chunk, (str, os.PathLike)) and _CHUNK.fullmatch(os.path.basename(chunk)) for chunk in chunks):
        chunks.sort(key=os.path.basename)
    return b"".join(_read(chunk) for chunk in chunks)


def _read(chunk):
    if isinstance(chunk, (str, os.PathLike)):
        with open(chunk, "rb") as file:
            return file.read()
    return chunk.read() if hasattr(chunk, "read") else bytes(chunk)


def utc(time) -> np.datetime64:
    """Returns a time as datetime64[s] in UTC. Texts and times without a zone are UTC.

    >>> print(utc("1999-05-03T23:56Z"))
    1999-05-03T23:56:00
    """
    if isinstance(time, datetime.datetime) and time.tzinfo is not None:
        time = time.astimezone(datetime.timezone.utc).replace(tzinfo=None)
    return np.datetime64(time.rstrip("Zz") if isinstance(time, str) else time).astype("datetime64[s]")


def fetched(station: str, time, bucket: str = BUCKET) -> bytes:
    """Fetches the last volume that the station began at or before the time, and logs its address. The bucket has the
    layout of the public bucket. Returns the bytes of the file.

    Raises Error: bad_argument if the name is no station's, not_found if no volume began in the 30 minutes before, io if
    the bucket does not answer. Each request is tried four times.
    """
    if not re.fullmatch("[A-Za-z0-9]{4}", station):
        raise Error(f"'{station}' is no station: a station has four letters, such as KTLX", "bad_argument")
    if not bucket.startswith(("http://", "https://")):
        raise Error(f"the bucket '{bucket}' is no address of http or https", "bad_argument")
    station, time, bucket = station.upper(), utc(time), bucket.rstrip("/")
    days = {time.astype("datetime64[D]"), (time - _LONGEST).astype("datetime64[D]")}
    volumes = sorted(volume for day in days for volume in _volumes_of_day(bucket, station, day))
    begun = [volume for volume in volumes if time - _LONGEST <= volume[0] <= time]
    if not begun:
        nearest = min(volumes, key=lambda volume: abs(volume[0] - time), default=None)
        known = f"the nearest began at {nearest[0]}Z" if nearest else "the bucket has none of that day"
        raise Error(f"{bucket}: no volume of {station} began in the 30 minutes before {time}Z; {known}", "not_found")
    _, key, size = begun[-1]
    address = f"{bucket}/{urllib.parse.quote(key)}"
    _log.warning("fetching %s (%.1f MB)", address, size / 1e6)
    return _get(address, size)


def _volumes_of_day(bucket, station, day):
    """Returns start, key and size in bytes of each volume in the bucket's listing of a day."""
    prefix, token, found = f"{str(day).replace('-', '/')}/{station}/", "", []
    for _ in range(_MOST_PAGES):
        question = {"list-type": 2, "prefix": prefix} | ({"continuation-token": token} if token else {})
        address = f"{bucket}/?{urllib.parse.urlencode(question)}"
        try:
            page = ElementTree.fromstring(_get(address))
        except ElementTree.ParseError as error:
            raise Error(f"{address}: the answer is not the listing of a bucket: {error}", "corrupt") from None
        for item in page.iterfind("{*}Contents"):
            key, size = item.findtext("{*}Key", ""), item.findtext("{*}Size", "")
            name = _VOLUME.match(key.rpartition("/")[2])
            if name and size.isdigit():
                start = datetime.datetime.strptime(name[1], "%Y%m%d_%H%M%S")
                found.append((np.datetime64(start, "s"), key, int(size)))
        token = page.findtext("{*}NextContinuationToken")
        if not token:
            return found
    raise Error(f"{address}: the listing does not end", "corrupt")


def _get(address, size=None):
    """Returns the bytes at an address, `size` of them if it is known."""
    for wait_s in (*_WAITS_S, None):
        try:
            with urllib.request.urlopen(address, timeout=30) as answer:
                data = answer.read((_MOST_BYTES if size is None else size) + 1)
            if size is None and len(data) <= _MOST_BYTES or len(data) == size:
                return data
            reason = f"the answer has {len(data)} bytes, not {size if size is not None else 'a listing'}"
        except urllib.error.HTTPError as error:
            if error.code < 500:
                raise Error(f"{address}: {error.code} {error.reason}", "not_found" if error.code == 404 else "io") from None
            reason = f"{error.code} {error.reason}"
        except (OSError, http.client.HTTPException) as error:
            reason = str(error)
        if wait_s is None:
            raise Error(f"{address}: {reason}", "io")
        clock.sleep(wait_s)
