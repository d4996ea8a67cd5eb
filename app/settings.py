"""Settings of the service: read once from the environment (prefix ``MICROTEXTURE_``), frozen, passed down."""

import os
import re
from pathlib import Path
from typing import Literal
from urllib.parse import quote, urlsplit

from pydantic import Field, SecretStr, field_validator
from pydantic_settings import BaseSettings, SettingsConfigDict

_PACKAGE = Path(__file__).resolve().parent
_INSTALLED = _PACKAGE / "assets"  # where pyproject.toml has a wheel keep templates, static files and samples
ROOT = _INSTALLED if _INSTALLED.is_dir() else _PACKAGE.parent  # of the three: an installed wheel's, or the checkout

MEBIBYTE = 1 << 20
MOST = 1 << 50  # bytes, pixels or frames: beyond any machine, and far from what no float holds
YEAR = 366 * 24 * 3600.0  # seconds
_ONE_LIMIT = r"[1-9]\d{0,8}/(?:[1-9]\d{0,3} )?(?:second|minute|hour|day)s?"
_LIMIT = re.compile(f"{_ONE_LIMIT}(?:;{_ONE_LIMIT})*", re.ASCII)
_HOST = re.compile(r"(?:\*\.)?[\w-]+(?:\.[\w-]+)*\.?|\[[0-9a-fA-F:.]+\]", re.ASCII)


class Settings(BaseSettings):
    """Everything an operator may set; every field is the environment variable ``MICROTEXTURE_<NAME>``."""

    model_config = SettingsConfigDict(
        env_prefix="MICROTEXTURE_", frozen=True, extra="ignore", hide_input_in_errors=True
    )

    # State
    data_dir: Path = Field(Path("data"), description="Directory of the database and of the content-addressed files.")
    database_url: SecretStr | None = Field(
        None, description="SQLAlchemy URL, e.g. postgresql+psycopg://…; default: SQLite under the data directory."
    )
    samples_dir: Path = Field(ROOT / "samples", description="Directory of the bundled photographs and their catalogue.")

    min_free_bytes: int = Field(
        256 * MEBIBYTE, ge=0, le=MOST, description="Room left on the disk below which nothing more is taken in."
    )

    # Engine
    scheduler: str | None = Field(
        None, description="Address of a Dask scheduler (tcp://…); default: processes of ours."
    )
    workers: int = Field(
        max(2, os.cpu_count() or 2), ge=1, le=4096, description="Worker processes of the embedded engine."
    )
    threads: int = Field(
        max(1, os.cpu_count() or 1), ge=1, le=4096, description="Threads that one experiment computes with."
    )
    worker_memory: int = Field(
        2048 * MEBIBYTE, ge=256 * MEBIBYTE, le=MOST, description="Bytes a worker process may use."
    )
    time_limit: float = Field(300.0, gt=0, le=YEAR, description="Seconds one experiment may run.")
    queue_limit: int = Field(100, ge=1, le=MOST, description="Experiments that may wait; one more is answered 503.")

    # Input limits
    max_upload_bytes: int = Field(32 * MEBIBYTE, ge=1, le=MOST, description="Bytes of an uploaded file.")
    max_upload_pixels: int = Field(
        50_000_000, ge=1, le=MOST, description="Pixels (width × height) of an uploaded picture."
    )
    max_output_pixels: int = Field(
        1 << 26, ge=1, le=MOST, description="Pixels (width × height) of a synthesised texture."
    )
    max_film_frames: int = Field(600, ge=2, le=MOST, description="Frames of an uploaded video.")
    max_film_seconds: float = Field(60.0, gt=0, le=YEAR, description="Seconds that an uploaded video plays.")
    max_film_pixels: int = Field(
        1 << 28, ge=1, le=MOST, description="Pixels (width × height × frames) of a video, uploaded or synthesised."
    )
    decode_seconds: float = Field(20.0, gt=0, le=YEAR, description="Seconds that decoding one upload may take.")
    decode_memory: int = Field(
        2048 * MEBIBYTE, ge=64 * MEBIBYTE, le=MOST, description="Bytes that decoding one upload may use."
    )

    # Fair shares
    limits: bool = Field(True, description="Whether clients have shares and limits; False for a private host.")
    queue_share: float = Field(
        0.2, gt=0, le=1, description="Part of the queue that one client's waiting experiments may take."
    )
    limit_uploads: str = Field("30/minute;300/hour", description="Uploads of one client.")
    limit_experiments: str = Field("60/minute;600/hour", description="Experiments that one client may submit.")
    limit_conversions: str = Field(
        "60/minute;600/hour", description="Outputs in another format and ZIP files that one client may ask for."
    )
    limit_deep: str = Field("20/minute;100/hour", description="Outputs at 16 bits that one client may ask for.")
    limit_views: str = Field(
        "1200/minute", description="Pictures of its uploads, measurements and checks that one client may ask for."
    )
    limit_streams: int = Field(16, ge=1, le=MOST, description="Event streams that one client may have open.")
    limit_address: int = Field(
        4, ge=1, le=MOST, description="How many clients' limits and shares one network address may use."
    )
    upload_budget: int = Field(
        4096 * MEBIBYTE, ge=1, le=MOST, description="Bytes of disk that one client's uploads may take in a day."
    )

    # Web
    base_url: str | None = Field(
        None, description="Public address, e.g. https://texture.example.org; default: the request's."
    )
    trusted_hosts: str = Field(
        "",
        description="Names that it is reached by, with commas, e.g. texture.example.org,*.example.net; other Host "
        "headers are answered 400. Default: any name.",
    )
    operator_token: SecretStr | None = Field(
        None, description="Bearer token that may delete any experiment; take 16 random characters or more."
    )
    catalogue: bool = Field(True, description="Whether the figures of the pages are made in the background.")
    sample_keep_hours: float = Field(
        24.0, ge=0, le=100 * YEAR / 3600, description="Hours an uploaded sample without an experiment is kept."
    )
    keep_unlisted_days: float | None = Field(
        None,
        gt=0,
        le=100 * YEAR / 86400,
        description="Days that a finished unlisted experiment is kept; for ever if unset.",
    )
    keep_days: float | None = Field(
        None, gt=0, le=100 * YEAR / 86400, description="Days that any finished experiment is kept; for ever if unset."
    )
    log_level: Literal["debug", "info", "warning", "error"] = Field(
        "info", description="The least that is logged: debug, info, warning or error."
    )
    log_format: Literal["text", "json"] = Field("text", description="What a line of the log is: text or json.")

    @field_validator("limit_uploads", "limit_experiments", "limit_conversions", "limit_deep", "limit_views")
    @classmethod
    def _check_limit(cls, text: str) -> str:
        if text and not _LIMIT.fullmatch(text):
            raise ValueError("write a limit as 30/minute;300/hour, or nothing for none")
        return text

    @field_validator("trusted_hosts")
    @classmethod
    def _check_hosts(cls, text: str) -> str:
        for name in _split(text):
            if not _HOST.fullmatch(name):
                raise ValueError(f"{name!r} is no host name: leave out the scheme, the port and the path")
        return text

    @property
    def hosts(self) -> frozenset[str]:
        """The names of ``trusted_hosts``, and that of the public address; none if any name will do."""
        names = frozenset(name.lower().removesuffix(".") for name in _split(self.trusted_hosts))
        public = urlsplit(self.base_url or "").hostname
        return names | {public} if names and public else names

    @property
    def sql_url(self) -> str:
        """The database's SQLAlchemy URL."""
        if self.database_url is not None:
            return self.database_url.get_secret_value()
        return f"sqlite:///{quote(str((self.data_dir / 'microtexture.sqlite3').resolve()))}"


def _split(text: str) -> list[str]:
    return [part.strip() for part in text.split(",") if part.strip()]
