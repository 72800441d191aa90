(* kickdrift verdict --lambda1 1*pi^2 --lambda2 1/25*pi^4 --h1 1/10*pi^-1 --h2 7/20*pi^-1 --certificate pi_wrong_kind.v *)
From Coq Require Import Reals QArith.
From Kickdrift Require Import Vocabulary PiCertificate.

(** kind, p, q with h2/h1 = p/q, then h1, lambda1, h2, lambda2. *)
Theorem kickdrift_verdict :
  verdict (Hyperbolic Minus) 7 2 (1 / 10 * powerRZ PI (-1)) (1 / 1 * powerRZ PI 2) (7 / 20 * powerRZ PI (-1)) (1 / 25 * powerRZ PI 4).
Proof. certify_pi (1 # 10, (-1)%Z) (1 # 1, 2%Z) (7 # 20, (-1)%Z) (1 # 25, 4%Z). Qed.
Print Assumptions kickdrift_verdict.
