(* kickdrift verdict --lambda1 1*pi^2 --lambda2 1/25*pi^2 --h1 101/1000 --h2 899/1000 --certificate pi_thousand_kicks.v *)
From Coq Require Import Reals QArith.
From Kickdrift Require Import Vocabulary PiCertificate.

(** kind, p, q with h2/h1 = p/q, then h1, lambda1, h2, lambda2. *)
Theorem kickdrift_verdict :
  verdict Elliptic 899 101 (101 / 1000 * powerRZ PI 0) (1 / 1 * powerRZ PI 2) (899 / 1000 * powerRZ PI 0) (1 / 25 * powerRZ PI 2).
Proof. certify_pi (101 # 1000, 0%Z) (1 # 1, 2%Z) (899 # 1000, 0%Z) (1 # 25, 2%Z). Qed.
Print Assumptions kickdrift_verdict.
