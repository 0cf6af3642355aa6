"""The engine "stormcellar" of xarray: xarray.open_dataset(FILE, engine="stormcellar", group="sweep_3")."""

import os

from xarray.backends import BackendEntrypoint

from .trees import open_volume


def _groups(source, options):
    if options.get("time") is not None:  # xarray has made a path of the station's name
        source = os.path.basename(source)
    return open_volume(source, **options)


class StormcellarBackendEntrypoint(BackendEntrypoint):
    """Opens Level II files. `group` is "sweep_0" (default), "sweep_1" and so on, or "/" for the facts of the volume.
    Further arguments are those of stormcellar.open_volume().

    >>> import xarray
    >>> sweep = xarray.open_dataset(FILE, engine=StormcellarBackendEntrypoint, group="sweep_1")
    >>> int(sweep["sweep_number"]), dict(sweep["VRADH"].sizes)
    (1, {'azimuth': 367, 'range': 920})
    """

    description = "Level II files of weather radars (NEXRAD, TDWR)"
    open_dataset_parameters = ("filename_or_obj", "drop_variables", "group", "moments", "derive", "sort", "status",
                               "packed", "station", "volume", "time", "bucket")

    def open_dataset(self, filename_or_obj, *, drop_variables=None, group="sweep_0", **options):
        groups = _groups(filename_or_obj, options)
        name = "/" + (group or "").strip("/")
        if name not in groups:
            raise ValueError(f"there is no group {group!r}; the groups are {', '.join(groups)}")
        return groups[name].drop_vars(drop_variables or (), errors="ignore")

    def open_groups_as_dict(self, filename_or_obj, *, drop_variables=None, **options):
        return {name: dataset.drop_vars(drop_variables or (), errors="ignore")
                for name, dataset in _groups(filename_or_obj, options).items()}

    def open_datatree(self, filename_or_obj, *, drop_variables=None, **options):
        from xarray import DataTree

        return DataTree.from_dict(self.open_groups_as_dict(filename_or_obj, drop_variables=drop_variables, **options))

    def guess_can_open(self, filename_or_obj):
        """Returns True for names of archived volumes, such as KLOT20220317_000842_V06 or KTLX19990503_235621.gz."""
        if not isinstance(filename_or_obj, (str, os.PathLike)):
            return False
        name = os.path.basename(os.fspath(filename_or_obj))
        return len(name) > 18 and name[:4].isalnum() and name[4:12].isdigit() and name[12] == "_" \
            and name[13:19].isdigit() or name.endswith(".ar2v")
