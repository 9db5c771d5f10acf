"""The field's certificate authority: a key pair that signs the members' certificates (P-256, X.509)."""

from __future__ import annotations

import ipaddress
from datetime import UTC, datetime, timedelta

from cryptography import x509
from cryptography.exceptions import InvalidSignature
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.hazmat.primitives.serialization import pkcs12
from cryptography.x509.oid import ExtendedKeyUsageOID, NameOID

EARLY = timedelta(minutes=5)  # certificates begin before they are made: members' clocks differ


class Authority:
    """Signs certificates. Made by `Authority.new` or from the PEM files of an earlier one."""

    def __init__(self, key: ec.EllipticCurvePrivateKey, certificate: x509.Certificate) -> None:
        self._key = key
        self.certificate = certificate

    @classmethod
    def new(cls, field: str, now: datetime, days: int) -> Authority:
        """A new authority for a field, valid ten times as long as its members' certificates."""
        key = ec.generate_private_key(ec.SECP256R1())
        subject = _name(f"Apollonius field {field}")
        builder = _builder(subject, subject, key.public_key(), now, 10 * days)
        builder = builder.add_extension(x509.BasicConstraints(ca=True, path_length=0), critical=True)
        return cls(key, builder.sign(key, hashes.SHA256()))

    @classmethod
    def load(cls, key_pem: bytes, certificate_pem: bytes) -> Authority:
        """The authority of two PEM texts. Raises ValueError for texts that are none, or no pair."""
        key = serialization.load_pem_private_key(key_pem, None)
        certificate = x509.load_pem_x509_certificate(certificate_pem)
        if not isinstance(key, ec.EllipticCurvePrivateKey) or key.public_key() != certificate.public_key():
            raise ValueError("the authority's key does not belong to its certificate")
        return cls(key, certificate)

    def key_pem(self) -> bytes:
        """The private key, unencrypted: for a file that only its owner may read."""
        return _private_pem(self._key)

    def issue(self, name: str, hosts: tuple[str, ...], now: datetime, days: int) -> tuple[bytes, bytes]:
        """A new key pair for a member: (certificate, private key), both PEM.

        `name` is the certificate's common name; `hosts` are the names and addresses it may answer at.
        The certificate ends when the authority does, if that comes first.
        """
        key = ec.generate_private_key(ec.SECP256R1())
        builder = _builder(_name(name), self.certificate.subject, key.public_key(), now, days,
                           self.certificate.not_valid_after_utc)  # fmt: skip
        uses = [ExtendedKeyUsageOID.CLIENT_AUTH, ExtendedKeyUsageOID.SERVER_AUTH]
        builder = builder.add_extension(x509.BasicConstraints(ca=False, path_length=None), critical=True)
        builder = builder.add_extension(x509.ExtendedKeyUsage(uses), critical=False)
        alternatives = [_alternative(host) for host in (name, *hosts)]
        builder = builder.add_extension(x509.SubjectAlternativeName(alternatives), critical=False)
        certificate = builder.sign(self._key, hashes.SHA256())
        return certificate.public_bytes(serialization.Encoding.PEM), _private_pem(key)

    def signed(self, certificate: x509.Certificate) -> bool:
        """Whether this authority signed a certificate."""
        try:
            certificate.verify_directly_issued_by(self.certificate)
        except (ValueError, TypeError, InvalidSignature):
            return False
        return True


def common_name(certificate: x509.Certificate) -> str:
    """The name in a certificate; "" where it has none."""
    names = certificate.subject.get_attributes_for_oid(NameOID.COMMON_NAME)
    return str(names[0].value) if names else ""


def fingerprint(certificate: x509.Certificate) -> str:
    """The first 16 hexadecimal digits of a certificate's SHA-256, for people to compare."""
    return certificate.fingerprint(hashes.SHA256()).hex()[:16]


def for_browser(name: str, certificate_pem: bytes, key_pem: bytes) -> bytes:
    """A member's pair as PKCS #12 without a password, as browsers import it."""
    key = serialization.load_pem_private_key(key_pem, None)
    assert isinstance(key, ec.EllipticCurvePrivateKey)
    certificate = x509.load_pem_x509_certificate(certificate_pem)
    plain = serialization.NoEncryption()
    return pkcs12.serialize_key_and_certificates(name.encode(), key, certificate, None, plain)


def pem(certificate: x509.Certificate) -> bytes:
    """A certificate as PEM text."""
    return certificate.public_bytes(serialization.Encoding.PEM)


def _builder(
    subject: x509.Name,
    issuer: x509.Name,
    public: ec.EllipticCurvePublicKey,
    now: datetime,
    days: int,
    end: datetime | None = None,
) -> x509.CertificateBuilder:
    ends = now + timedelta(days=days)
    return (
        x509.CertificateBuilder()
        .subject_name(subject)
        .issuer_name(issuer)
        .public_key(public)
        .serial_number(x509.random_serial_number())
        .not_valid_before(now.astimezone(UTC) - EARLY)
        .not_valid_after(ends if end is None else min(ends, end))
    )


def _name(text: str) -> x509.Name:
    return x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, text)])


def _alternative(host: str) -> x509.GeneralName:
    try:
        return x509.IPAddress(ipaddress.ip_address(host))
    except ValueError:
        return x509.DNSName(host)


def _private_pem(key: ec.EllipticCurvePrivateKey) -> bytes:
    return key.private_bytes(
        serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8, serialization.NoEncryption()
    )
